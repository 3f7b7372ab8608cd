// SPDX-License-Identifier: BSD-3-Clause
// The data-ready line of a DPS310 instead of polling.
#include <doctest/doctest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/dps310/sensor.hpp"
#include "tests/drivers/dps310/chip_model.hpp"

namespace isobar::test::test_ready_line {

using namespace isobar::dps310;

namespace {

/// The line at the chip's interrupt, or a line at nothing.
class ModelLine final : public EdgeLine {
 public:
  explicit ModelLine(isobar::dps310::ChipModel& chip) : chip_(&chip) {}
  int open() noexcept override { return open_error; }
  void close() noexcept override {}
  int level(bool& high) noexcept override {
    high = false;
    return 0;
  }
  int read(std::span<LineEdge, kQueue> edges, std::size_t& count) noexcept override {
    count = 0;
    for (; readable() && count < kQueue; ++read_)
      edges[count++] = {chip_->interrupts[read_] + kApartNs, true};
    return read_error;
  }
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return chip_->now_ns() + kApartNs; }
  [[nodiscard]] int file_descriptor() const noexcept override { return 7; }
  [[nodiscard]] bool readable() const { return connected && read_ < chip_->interrupts.size(); }

  bool connected = true;
  int open_error = 0;
  int read_error = 0;

 private:
  static constexpr std::int64_t kApartNs = -400'000'000'000;  ///< clock of the line minus robot clock
  isobar::dps310::ChipModel* chip_;
  std::size_t read_ = 0;
};

/// Steps the driver when the line is readable and at the times that it asks for, with late calls.
struct LineBench {
  LineBench() {
    auto made = std::make_unique<ModelLine>(chip);
    line = made.get();
    sensor = std::make_unique<Sensor>(Settings{}, std::make_unique<isobar::dps310::ModelBus>(chip), 0,
                                      std::move(made));
  }
  void run(double seconds) {
    const std::int64_t end_ns = chip.now_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (chip.now_ns() < end_ns) {
      chip.run_until(chip.now_ns() + 100'000);
      if (chip.now_ns() < next_ns && !line->readable()) continue;
      chip.run_until(chip.now_ns() + late_ns);
      ++steps;
      const Device<PressureSample>::Step step = sensor->step(chip.now_ns());
      next_ns = step.next_ns;
      if (step.has_sample) samples.push_back(step.sample);
    }
  }
  [[nodiscard]] double rms_stamp_error_s(double pa_per_s) const {
    double sum = 0.0;
    for (const PressureSample& s : samples) {
      const double error_s =
          (s.pressure_pa - chip.pressure_pa(static_cast<double>(s.stamp_ns) * 1e-9)) / pa_per_s;
      sum += error_s * error_s;
    }
    return std::sqrt(sum / static_cast<double>(samples.size()));
  }

  isobar::dps310::ChipModel chip;
  ModelLine* line = nullptr;
  std::unique_ptr<Sensor> sensor;
  std::int64_t next_ns = 0;
  std::int64_t late_ns = 0;
  std::uint64_t steps = 0;
  std::vector<PressureSample> samples;
};

}  // namespace

TEST_CASE("with a data-ready line the sensor is read once a measurement, and stamps are exact to 0.3 ms") {
  LineBench bench;
  const double t0_s = static_cast<double>(bench.chip.now_ns()) * 1e-9;
  bench.chip.pressure_pa = [t0_s](double t_s) { return 110'000.0 - 2'000.0 * (t_s - t0_s); };
  bench.run(0.5);
  bench.samples.clear();
  bench.steps = 0;
  bench.late_ns = 3'000'000;  // a busy machine: the edge's stamp does not depend on it
  bench.run(5.0);
  CHECK(bench.samples.size() >= 158);
  CHECK(bench.samples.size() <= 161);
  CHECK(bench.steps < 170);
  CHECK(bench.rms_stamp_error_s(-2'000.0) < 0.3e-3);
  CHECK(bench.sensor->file_descriptor() == 7);
  CHECK((bench.chip.held(kConfig) & 0xF0) == (kInterruptHigh | kInterruptPressure));
}

TEST_CASE("a line at which nothing comes leaves the sensor polled, at its full rate") {
  LineBench bench;
  bench.line->connected = false;
  bench.run(0.5);
  bench.samples.clear();
  bench.run(5.0);
  CHECK(bench.samples.size() >= 158);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
}

TEST_CASE(
    "a line that loses its connection costs two measurements at most, and is used again when it is back") {
  LineBench bench;
  bench.run(2.0);
  bench.samples.clear();
  bench.line->connected = false;
  bench.run(5.0);
  CHECK(bench.samples.size() >= 156);
  bench.line->connected = true;
  bench.run(1.0);
  bench.steps = 0;
  bench.run(5.0);
  CHECK(bench.steps < 170);
  CHECK(bench.sensor->status().counters.starts == 1);
}

TEST_CASE("a line that cannot be requested, or no longer read, is reported with the reason") {
  LineBench bench;
  bench.line->open_error = EBUSY;
  bench.run(1.0);
  CHECK(bench.samples.empty());
  CHECK(std::string(bench.sensor->status().fault.data()) ==
        "the data-ready line cannot be requested (Device or resource busy)");
  bench.line->open_error = 0;
  bench.run(2.0);
  CHECK(bench.sensor->status().state == DeviceState::kMeasuring);
  bench.line->read_error = ENODEV;
  bench.run(0.1);
  CHECK(std::string(bench.sensor->status().fault.data()) ==
        "the data-ready line cannot be read (No such device)");
}

}  // namespace isobar::test::test_ready_line
