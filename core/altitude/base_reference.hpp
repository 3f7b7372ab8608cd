// SPDX-License-Identifier: BSD-3-Clause
// Reference pressure of the height, from up to two base stations.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/base_station.hpp"
#include "core/altitude/height_datum.hpp"
#include "core/altitude/station_vote.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Changes of the reference that a filter of the height must handle.
enum class ReferenceEvent : std::uint8_t {
  kNone,
  kBaseJoined,    ///< first base station: weather no longer moves the height
  kBaseLost,      ///< the last pressure is held: weather moves the height
  kBaseReturned,  ///< height_m steps by the weather during the outage, weather_shift_m
  kBaseSwitched,  ///< the other station took over; height_m steps by weather_shift_m, the old one's error
};

/// One active and one standby station. The standby's offset is learnt while both agree, so that it can take
/// over without a step. If they diverge by more than air and noise explain, StationVote finds the wrong one.
/// A wrong or silent station is replaced; the one that took over stays the reference (no switching back).
class BaseReference {
 public:
  static constexpr std::size_t kStations = 2;

  explicit BaseReference(const AltimeterConfig& config);

  /// Reference until the first base station: `log_pa` is ln of the robot's first pressure [Pa].
  void start(double log_pa) { log_pa_ = log_pa; }

  /// Continues the datum of an earlier run, before the first sample.
  void resume(const HeightDatum& datum);
  /// Fills the base stations of the datum.
  void describe(HeightDatum& datum) const;

  /// `air_log`: see BaseStation::add().
  PressureStatus add(const PressureSample& sample, std::int64_t now_ns, double air_log);

  /// The sample added last, if it belongs to the reference: ln of its pressure [Pa] in the datum of log_pa(), but
  /// not smoothed, and its relative variance. Null otherwise.
  struct Sample {
    double log_pa = 0.0;
    double variance = 0.0;
  };
  [[nodiscard]] std::optional<Sample> reference_sample(std::size_t station, std::int64_t now_ns) const;
  /// Learnt sample interval of the reference station [s]; 0: unknown.
  [[nodiscard]] double interval_s() const { return stations_[active_].interval_s(); }

  /// Call with every robot sample. `witness_log`: ln of the robot's pressure reduced to a common height by
  /// dead reckoning; NaN without dead reckoning.
  ReferenceEvent update(std::int64_t now_ns, double witness_log);

  /// After a clock jump: accept the next samples whatever their stamps.
  void restart_clock();

  /// ln of the reference pressure [Pa].
  [[nodiscard]] double log_pa() const { return log_pa_; }
  /// Relative variance of the reference (of log_pa()) while a station is present.
  [[nodiscard]] double variance(std::int64_t now_ns) const;
  [[nodiscard]] bool present() const { return state_ == State::kPresent; }
  /// Whether there was a base station at any time.
  [[nodiscard]] bool ever() const { return state_ != State::kNever; }
  [[nodiscard]] double age_s(std::int64_t now_ns) const { return stations_[active_].age_s(now_ns); }
  /// Step of log_pa() at kBaseReturned and kBaseSwitched.
  [[nodiscard]] double shift_log() const { return shift_log_; }

  [[nodiscard]] BarometerFault fault(std::size_t station, std::int64_t now_ns) const;
  /// Index of the current or last reference station.
  [[nodiscard]] std::size_t active() const { return active_; }
  /// Number of stations that could be the reference now.
  [[nodiscard]] std::size_t usable_count(std::int64_t now_ns) const;
  /// Both stations are present and disagree, and the wrong one cannot be identified.
  [[nodiscard]] bool undecided() const { return undecided_; }

 private:
  enum class State : std::uint8_t { kNever, kPresent, kLost };

  [[nodiscard]] bool usable(std::size_t station, std::int64_t now_ns) const;
  [[nodiscard]] int choose(std::int64_t now_ns) const;
  void adopt(std::size_t station);
  void compare(std::int64_t now_ns, double dt_s, double witness_log);
  void learn_standby(double difference_log, double dt_s);
  void watch_condemned(double difference_log);

  AltimeterConfig config_;
  std::array<BaseStation, kStations> stations_;
  std::array<double, kStations> offset_log_{};  // log_pa() = value + this
  std::array<bool, kStations> offset_known_{};
  std::array<bool, kStations> condemned_{};
  StationVote vote_;
  State state_ = State::kNever;
  std::size_t active_ = 0;
  double log_pa_ = 0.0;
  double shift_log_ = 0.0;
  double learnt_s_ = 0.0;        // learning time of the standby's offset
  double divergence_log_ = 0.0;  // smoothed difference of the stations
  double stopped_log_ = 0.0;     // difference of the stations since the condemned one last moved
  double stopped_s_ = 0.0;       // time since it last moved
  std::int64_t good_ns_ = 0;     // last time with a usable station
  std::int64_t updated_ns_ = 0;
  bool undecided_ = false;
};

}  // namespace isobar
