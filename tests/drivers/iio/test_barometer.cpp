// SPDX-License-Identifier: BSD-3-Clause
// Kernel barometers, on an imitation of their sysfs folder.
#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "drivers/iio/barometer.hpp"

namespace isobar::test::test_barometer {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kStuckNs = 1'500'000'000;

/// A device's folder, removed at the end.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("isobar-iio-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void put(const std::string& file, const std::string& text) const {
    std::ofstream(path_ / file) << text << "\n";
  }
  void remove(const std::string& file) const { fs::remove(path_ / file); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

struct Bench {
  template <class Settings>
  explicit Bench(const Settings& settings, std::int64_t stuck_ns = 0) : device(settings, stuck_ns) {}
  /// Runs for a time; `before_each` prepares the next reading.
  void run(double seconds, const std::function<void()>& before_each = {}) {
    const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(seconds * 1e9);
    while (now_ns < end_ns) {
      if (before_each) before_each();
      const Device<PressureSample>::Step step = device.step(now_ns);
      REQUIRE(step.next_ns > now_ns);
      if (step.has_sample) samples.push_back(step.sample);
      now_ns = step.next_ns;
    }
  }
  [[nodiscard]] std::string fault() const { return device.status().fault.data(); }
  [[nodiscard]] DeviceState state() const { return device.status().state; }

  iio::Barometer device;
  std::int64_t now_ns = 1'000'000'000;
  std::vector<PressureSample> samples;
};

iio::Settings at(const Folder& folder) { return {folder.path(), 10}; }
iio::SetraSettings setra_at(const Folder& folder) { return {at(folder), "in_voltage0", setra278::Span{}}; }

}  // namespace

TEST_CASE("a processed pressure in kPa and a temperature in millidegrees become a sample") {
  const Folder folder;
  folder.put("in_pressure_input", "100.843250");
  folder.put("in_temp_input", "21400");
  Bench bench(at(folder));
  bench.run(2.0);
  REQUIRE(bench.samples.size() >= 18);
  CHECK(bench.samples[0].pressure_pa == doctest::Approx(100'843.25).epsilon(1e-12));
  CHECK(bench.samples[0].temperature_c == doctest::Approx(21.4));
  CHECK(std::isnan(bench.samples[0].variance_pa2));
  CHECK(bench.samples[1].stamp_ns - bench.samples[0].stamp_ns == 100'000'000);
  CHECK(bench.device.place() == "barometer " + folder.path());
}

TEST_CASE("a raw pressure uses scale and offset of its channel, or those shared by its kind") {
  const Folder folder;
  folder.put("in_pressure_raw", "4130000");
  folder.put("in_pressure_scale", "0.000024414");
  Bench bench(at(folder));
  bench.run(0.5);
  REQUIRE_FALSE(bench.samples.empty());
  CHECK(bench.samples[0].pressure_pa == doctest::Approx(4'130'000 * 0.000024414 * 1e3));
  CHECK(std::isnan(bench.samples[0].temperature_c));

  const Folder adc;
  adc.put("in_voltage0_raw", "12000");
  adc.put("in_voltage_scale", "0.125000000");
  adc.put("in_voltage0_offset", "800");
  adc.put("in_temp_input", "55000");  // temperature of the converter, not of the air
  Bench volts(setra_at(adc));
  volts.run(0.5);
  REQUIRE_FALSE(volts.samples.empty());
  CHECK(volts.samples[0].pressure_pa == doctest::Approx(60e3 + (12'800 * 0.125e-3) / 2.5 * 50e3));
  CHECK(std::isnan(volts.samples[0].temperature_c));
  CHECK(volts.device.place() == "Setra 278 on " + adc.path() + " in_voltage0");
}

TEST_CASE(
    "an open wire of a Setra is reported within 0.5 s with the reason, and it measures again afterwards") {
  const Folder folder;
  folder.put("in_voltage0_raw", "1600");
  folder.put("in_voltage0_scale", "1");
  Bench bench(setra_at(folder));
  bench.run(1.0);
  const std::size_t good = bench.samples.size();
  REQUIRE(good > 5);
  folder.put("in_voltage0_raw", "3");
  bench.run(0.5);
  CHECK(bench.state() == DeviceState::kImplausible);
  CHECK(bench.fault() == "voltage at or below the span: wire open, or no supply?");
  CHECK(bench.samples.size() == good);
  CHECK(bench.device.status().counters.implausible >= 3);
  folder.put("in_voltage0_raw", "1601");
  bench.run(5.0);
  CHECK(bench.state() == DeviceState::kMeasuring);
  CHECK(bench.samples.back().pressure_pa == doctest::Approx(60e3 + 1.601 / 2.5 * 50e3));
}

TEST_CASE("a device that vanishes is retried, and may return with another scale") {
  const Folder folder;
  folder.put("in_pressure_raw", "100000");
  folder.put("in_pressure_scale", "0.001");
  Bench bench(at(folder));
  bench.run(1.0);
  REQUIRE(bench.state() == DeviceState::kMeasuring);
  // In sysfs the open file would fail with ENODEV; here it becomes empty.
  { std::ofstream(folder.path() + "/in_pressure_raw", std::ios::trunc); }
  bench.run(0.5);
  CHECK(bench.state() == DeviceState::kNoAnswer);
  CHECK(bench.fault().find("the file does not hold a number") == 0);
  folder.remove("in_pressure_raw");
  bench.run(3.0);
  CHECK(bench.fault() == "no such device or channel (No such file or directory)");
  folder.put("in_pressure_scale", "0.0005");
  folder.put("in_pressure_raw", "200000");
  bench.run(6.0);
  CHECK(bench.state() == DeviceState::kMeasuring);
  CHECK(bench.samples.back().pressure_pa == doctest::Approx(100e3));
}

TEST_CASE("a frozen value is reported within 2 s, unless the detection is off") {
  for (const bool watched : {true, false}) {
    const Folder folder;
    Bench bench(at(folder), watched ? kStuckNs : 0);
    int count = 0;
    folder.put("in_pressure_input", "99.5");
    bench.run(5.0, [&] { folder.put("in_pressure_input", "99." + std::to_string(500 + ++count % 7)); });
    REQUIRE(bench.state() == DeviceState::kMeasuring);
    bench.run(2.0);
    CHECK((bench.state() == DeviceState::kStuck) == watched);
    CHECK(bench.device.status().counters.stuck == (watched ? 1 : 0));
    bench.run(20.0);
    CHECK(bench.device.status().counters.stuck == (watched ? 1 : 0));
    bench.run(6.0, [&] { folder.put("in_pressure_input", "99." + std::to_string(500 + ++count % 7)); });
    CHECK(bench.state() == DeviceState::kMeasuring);
  }
}

TEST_CASE("hPa instead of kPa, text and infinities are refused and counted") {
  for (const char* text : {"1008.43", "0", "-5", "nan", "inf", "1e999", "pressure", "", "100.8abc"}) {
    CAPTURE(text);
    const Folder folder;
    folder.put("in_pressure_input", text);
    Bench bench(at(folder));
    bench.run(2.0);
    CHECK(bench.samples.empty());
    CHECK(bench.state() != DeviceState::kMeasuring);
    CHECK_FALSE(bench.fault().empty());
    CHECK(bench.device.status().counters.implausible + bench.device.status().counters.io_errors > 0);
  }
}

TEST_CASE("a failed thermometer makes the temperature NaN and keeps the pressure") {
  const Folder folder;
  folder.put("in_pressure_input", "100.0");
  folder.put("in_temp_raw", "85");
  folder.put("in_temp_scale", "250");
  Bench bench(at(folder));
  bench.run(1.0);
  REQUIRE_FALSE(bench.samples.empty());
  CHECK(bench.samples.back().temperature_c == doctest::Approx(21.25));
  folder.put("in_temp_raw", "broken");
  bench.run(1.0);
  CHECK(std::isnan(bench.samples.back().temperature_c));
  CHECK(bench.state() == DeviceState::kMeasuring);
}

}  // namespace isobar::test::test_barometer
