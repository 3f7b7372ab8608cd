// SPDX-License-Identifier: BSD-3-Clause
// Estimate of the air temperature between base station and robot from self-heated thermometers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/altitude/altitude_config.hpp"

namespace isobar {

/// Asymmetric low-pass of the coldest thermometer. A barometer's thermometer sits on a warm board: it reads
/// the air plus a self-heating that is zero at power-up, grows over minutes to some kelvins and is never
/// negative. Therefore
///   - the coldest sensor is the closest to the air,
///   - first readings are closer than later ones (a sensor just powered is still cool),
///   - a fall is real (colder air, or a colder place), a rise is mostly self-heating.
/// The estimate starts at the coldest first reading, follows the coldest sensor down within a minute and up
/// within an hour, and never stays further below it than AirTemperatureConfig::max_self_heating_k. The
/// expected self-heating of the coldest sensor is subtracted at the end. The estimate is slow and continuous,
/// so heights computed with it do not jump. Humidity is neglected: it raises the virtual temperature, by up
/// to 1.3 K at 20 degC and 50 %, whereas the self-heating left in sensors that were already warm makes the
/// estimate too high; the two errors have opposite signs.
class AirTemperatureTracker {
 public:
  static constexpr std::size_t kSensors = 3;  ///< 0: robot; 1, 2: base stations

  explicit AirTemperatureTracker(const AirTemperatureConfig& config);

  /// Takes a reading of one sensor. Ignored: a reading that is not finite, outside -60 … 100 degC, or not
  /// newer than the one before.
  void add(std::size_t sensor, std::int64_t stamp_ns, double temperature_c);

  /// After a clock jump: accept the next readings whatever their stamps. Keeps the estimate.
  void restart_clock() {
    thermometers_ = {};
    time_known_ = false;
  }

  /// Estimate [degC]; the configured value until the first reading.
  [[nodiscard]] double temperature_c() const {
    return started_ ? estimate_c_ - config_.expected_self_heating_k : config_.fixed_c;
  }

 private:
  struct Thermometer {
    std::int64_t stamp_ns = 0;
    double smooth_c = 0.0;
    double weight_s = 0.0;  // averaging time so far, up to the smoothing time
    bool started = false;
  };

  void smooth(Thermometer& thermometer, std::int64_t stamp_ns, double temperature_c) const;
  void follow(double lowest_c, double dt_s);

  AirTemperatureConfig config_;
  std::array<Thermometer, kSensors> thermometers_{};
  double estimate_c_;
  std::int64_t start_ns_ = 0;
  std::int64_t stamp_ns_ = 0;
  bool started_ = false;
  bool time_known_ = false;  // false until a reading after the start or restart_clock()
};

}  // namespace isobar
