// SPDX-License-Identifier: BSD-3-Clause
// Estimate of the air temperature between base station and robot from self-heated thermometers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/altitude/altitude_config.hpp"

namespace isobar {

/// Asymmetric low-pass of the coldest trusted thermometer. A barometer's thermometer sits on a warm board: it reads
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
///
/// The air that counts is the column through which the robot climbs, so the robot's thermometer has precedence: a
/// base station that is colder than self-heating explains stands in other air (outdoors, a cellar) and is left out.
/// A thermometer is *wrong*, and left out,
///   - from a step on that no air makes, until it reads what it should,
///   - where it disagrees at its beginning and is further from what is expected: the configured temperature at first,
///     the estimate later.
/// Which one of two thermometers is right cannot be known from one look; sigma_k() grows by the doubt.
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

  /// Estimate [degC]; the configured value until the first trusted reading.
  [[nodiscard]] double temperature_c() const {
    return started_ ? estimate_c_ - config_.expected_self_heating_k : config_.fixed_c;
  }
  /// Standard deviation of the estimate [K]: AirTemperatureConfig::sigma_k and the doubt about a thermometer.
  [[nodiscard]] double sigma_k() const;
  /// The thermometer of this sensor contradicts the others, or stepped.
  [[nodiscard]] bool wrong(std::size_t sensor) const {
    return thermometers_[sensor].wrong || thermometers_[sensor].stepped;
  }

 private:
  struct Thermometer {
    std::int64_t stamp_ns = 0;  // of the last reading that was no step
    double smooth_c = 0.0;
    double weight_s = 0.0;  // averaging time so far, up to the smoothing time
    double doubt_k = 0.0;   // standard deviation of the estimate from leaving it out
    bool started = false;
    bool judged = false;
    bool wrong = false;    // by judgement at its beginning
    bool stepped = false;  // now
  };

  /// False for a step.
  bool smooth(Thermometer& thermometer, std::int64_t stamp_ns, double temperature_c) const;
  void judge_beginnings(std::int64_t stamp_ns);
  void judge(std::size_t sensor, std::int64_t stamp_ns);
  void judge_alone(Thermometer& thermometer) const;
  void leave_out(Thermometer& loser, const Thermometer& winner) const;
  [[nodiscard]] double distance_k(const Thermometer& thermometer) const;
  [[nodiscard]] bool present(std::size_t sensor, std::int64_t stamp_ns) const;
  [[nodiscard]] bool usable(std::size_t sensor, std::int64_t stamp_ns) const;
  /// Coldest usable thermometer of the robot's air. False without one.
  bool find_coldest(std::int64_t stamp_ns, double& lowest_c);
  void begin(std::int64_t stamp_ns);
  void settle(std::int64_t stamp_ns);
  void follow(double lowest_c, double dt_s);

  AirTemperatureConfig config_;
  std::array<Thermometer, kSensors> thermometers_{};
  double estimate_c_;
  double other_air_k_ = 0.0;  // how much colder a left-out base station is than the robot
  std::int64_t start_ns_ = 0;
  std::int64_t stamp_ns_ = 0;
  bool started_ = false;
  bool settled_ = false;     // the estimate is better than the configured temperature
  bool time_known_ = false;  // false until a reading after the start or restart_clock()
};

}  // namespace isobar
