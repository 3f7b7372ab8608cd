// SPDX-License-Identifier: BSD-3-Clause
// Temperature of the air between base station and robot, from thermometers that read too warm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/altitude/altitude_config.hpp"

namespace isobar {

/// A barometer's thermometer sits on a warm board: it reads the air plus a self-heating that starts at zero
/// when it is powered, grows over minutes to some kelvins, and is never negative. So of everything the
/// sensors say
///   - the lowest of them is the closest,
///   - what they said first is closer than what they say later (a sensor powered just now has not warmed up),
///   - a fall is real (colder air, or a colder place), a rise mostly is not.
/// The estimate starts at the lowest first reading, follows the lowest sensor down within a minute and up
/// within an hour, and never stays more than the largest believable self-heating below the coldest sensor;
/// what even the coldest is expected to warm itself by is taken off at the end. It is slow and continuous, so
/// that the heights computed with it do not jump. Humidity (up to +1.3 K of virtual temperature at 20 degC
/// and 50 %) is left out: it has the opposite sign of the self-heating that remains in sensors that were
/// already warm.
class AirTemperatureTracker {
 public:
  static constexpr std::size_t kSensors = 3;  ///< robot's, two base stations'

  explicit AirTemperatureTracker(const AirTemperatureConfig& config);

  /// Takes a reading of one sensor. Readings that are not finite, outside -60 … 100 degC or back in time
  /// do nothing.
  void add(std::size_t sensor, std::int64_t stamp_ns, double temperature_c);

  /// The clock jumped: the next readings follow at once. The estimate stays.
  void restart_clock() {
    thermometers_ = {};
    time_known_ = false;
  }

  /// Estimate [degC]; the configured value until a thermometer has spoken.
  [[nodiscard]] double temperature_c() const {
    return started_ ? estimate_c_ - config_.expected_self_heating_k : config_.fixed_c;
  }

 private:
  struct Thermometer {
    std::int64_t stamp_ns = 0;
    double smooth_c = 0.0;
    double weight_s = 0.0;  // time averaged so far, up to the smoothing time
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
  bool time_known_ = false;
};

}  // namespace isobar
