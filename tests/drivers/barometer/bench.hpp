// SPDX-License-Identifier: BSD-3-Clause
// A chip's model, its driver and a clock.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "drivers/device/device.hpp"
#include "tests/drivers/barometer/model.hpp"

namespace isobar::test {

/// Steps the driver at the times that it asks for. Air without noise gives constant bits: the detection of a
/// stuck sensor needs noise.
template <class Model, class Sensor, class Settings>
struct BarometerBench {
  explicit BarometerBench(const Settings& settings = {}, std::int64_t stuck_ns = 0, bool bursts = true)
      : sensor(settings, make_bus(bursts), stuck_ns) {}

  void run(double seconds) {
    const std::int64_t end_ns = chip.now_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (next_ns < end_ns) {
      chip.run_until(next_ns + std::uniform_int_distribution<std::int64_t>(0, late_ns)(random));
      const std::int64_t called_ns = chip.now_ns();
      const Device<PressureSample>::Step step = sensor.step(called_ns);
      ++steps;
      REQUIRE(step.next_ns > called_ns);
      next_ns = step.next_ns;
      if (step.has_sample) samples.push_back(step.sample);
    }
    chip.run_until(end_ns);
  }
  /// Runs until the driver reports this state.
  /// @return time until then, or the limit [s]
  double time_until(DeviceState state, double limit_s) {
    const std::int64_t start_ns = chip.now_ns();
    const auto elapsed_s = [&] { return static_cast<double>(chip.now_ns() - start_ns) * 1e-9; };
    while (sensor.status().state != state && elapsed_s() < limit_s) run(0.005);
    return elapsed_s();
  }
  [[nodiscard]] std::string fault() const { return sensor.status().fault.data(); }
  /// Largest difference of a sample from the air at its stamp [Pa].
  [[nodiscard]] double largest_error_pa() const {
    double largest = 0.0;
    for (const PressureSample& s : samples) {
      const double truth_pa = chip.pressure_pa(static_cast<double>(s.stamp_ns) * 1e-9);
      largest = std::max(largest, std::abs(s.pressure_pa - truth_pa));
    }
    return largest;
  }

  Model chip;
  BarometerBus* bus = nullptr;
  Sensor sensor;
  std::int64_t next_ns = 0;
  std::int64_t late_ns = 0;  ///< largest delay of a call, as on a busy machine
  std::mt19937 random{5};
  std::uint64_t steps = 0;
  std::vector<PressureSample> samples;

 private:
  std::unique_ptr<BarometerBus> make_bus(bool bursts) {
    auto made = std::make_unique<BarometerBus>(chip);
    made->has_bursts = bursts;
    bus = made.get();
    return made;
  }
};

}  // namespace isobar::test
