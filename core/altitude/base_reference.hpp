// SPDX-License-Identifier: BSD-3-Clause
// The pressure that heights are measured against, from up to two base stations.
#pragma once

#include <array>
#include <cstdint>

#include "core/altitude/altitude_config.hpp"
#include "core/altitude/base_station.hpp"
#include "core/altitude/station_vote.hpp"
#include "core/samples.hpp"

namespace isobar {

/// What changed in the reference; whoever filters the heights must know.
enum class ReferenceEvent : std::uint8_t {
  kNone,
  kBaseJoined,  ///< a base station is there for the first time: weather no longer moves the height from here
                ///< on
  kBaseLost,    ///< the last pressure is held from here on: weather moves the height
  kBaseReturned,  ///< the weather since it was lost is now known, see weather_shift_m, and is in height_m
                  ///< already
  kBaseSwitched,  ///< another station is the reference; what the old one was wrong by is weather_shift_m
};

/// One station is the reference, the other stands by: its offset is learnt while both agree, so that it can
/// take over without a step. Where they part by more than air and noise explain, StationVote tells which of
/// them is wrong. A station that is wrong or silent is left; the one that took over stays.
class BaseReference {
 public:
  static constexpr std::size_t kStations = 2;

  explicit BaseReference(const AltimeterConfig& config);

  /// Reference before any base station: ln of the robot's own first pressure.
  void start(double log_pa) { log_pa_ = log_pa; }

  PressureStatus add(const PressureSample& sample, std::int64_t now_ns);

  /// To be called with every robot sample. `witness_log`: ln of the robot's pressure brought to one height by
  /// dead reckoning; NaN where there is none.
  ReferenceEvent update(std::int64_t now_ns, double witness_log);

  /// The clock jumped: samples follow at once, whatever their stamps.
  void restart_clock();

  [[nodiscard]] double log_pa() const { return log_pa_; }
  /// Relative variance of the reference as long as it is present.
  [[nodiscard]] double variance(std::int64_t now_ns) const;
  [[nodiscard]] bool present() const { return state_ == State::kPresent; }
  [[nodiscard]] bool ever() const { return state_ != State::kNever; }
  [[nodiscard]] double age_s(std::int64_t now_ns) const { return stations_[active_].age_s(now_ns); }
  /// With kBaseReturned and kBaseSwitched: by how much log_pa() moved with the event.
  [[nodiscard]] double shift_log() const { return shift_log_; }

  [[nodiscard]] BarometerFault fault(std::size_t station, std::int64_t now_ns) const;
  /// The station that is the reference, or was last.
  [[nodiscard]] std::size_t active() const { return active_; }
  /// Stations that could be the reference now.
  [[nodiscard]] std::size_t usable_count(std::int64_t now_ns) const;
  /// Both stations are there, disagree, and nobody can tell which is wrong.
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
  double learnt_s_ = 0.0;     // how long the standby's offset has been learnt
  double parted_log_ = 0.0;   // smoothed difference of the stations
  double stopped_log_ = 0.0;  // a condemned station's difference …
  double stopped_s_ = 0.0;    // … has been this for so long
  std::int64_t good_ns_ = 0;  // the last time that a station was usable
  std::int64_t updated_ns_ = 0;
  bool undecided_ = false;
};

}  // namespace isobar
