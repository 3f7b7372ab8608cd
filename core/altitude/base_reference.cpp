// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/base_reference.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Outage of the reference before the standby takes over: longer than a gust.
constexpr double kTakeOverS = 1.5;
// Time constant of the standby's learnt offset: a station's warm-up, 0.6 Pa within minutes, is tracked.
constexpr double kOffsetMemoryS = 300.0;
// Learning time of the offset, before which no station is judged: the offset is still settling.
constexpr double kOffsetLearntS = 20.0;
// Low-pass of the stations' difference: reduces turbulence of 0.2 Pa over seconds to 0.1 Pa.
constexpr double kDivergenceSmoothingS = 3.0;
// Divergence at which one station is wrong: more than ten sigmas of the smoothed turbulence, 13 cm.
constexpr double kDivergedPa = 1.5;
// Share of kDivergedPa above which the offset is frozen: a drift must not be absorbed into the offset.
constexpr double kFrozenShare = 0.4;
// Time without drift after which a condemned station is trusted again, with a new offset.
constexpr double kStoppedS = 120.0;
// Longest step of the offset filter: a pause must not count as observed time.
constexpr double kLongestStepS = 1.0;

}  // namespace

BaseReference::BaseReference(const AltimeterConfig& config)
    : config_(config), stations_{BaseStation(config), BaseStation(config)} {}

// A known station counts as lost: its return brings the reference back to the datum.
void BaseReference::resume(const HeightDatum& datum) {
  for (std::size_t i = 0; i < kStations; ++i) {
    offset_known_[i] = datum.station_known[i];
    offset_log_[i] = datum.station_offset_log[i];
    if (offset_known_[i]) state_ = State::kLost;
  }
}

// Jumps that a station has made are part of its offset: the next run begins with its present level.
void BaseReference::describe(HeightDatum& datum) const {
  for (std::size_t i = 0; i < kStations; ++i) {
    datum.station_known[i] = offset_known_[i] && !condemned_[i];
    datum.station_offset_log[i] = offset_log_[i] - stations_[i].jump_log();
  }
}

PressureStatus BaseReference::add(const PressureSample& sample, std::int64_t now_ns, double air_log) {
  if (sample.station >= kStations) return PressureStatus::kBadValue;
  return stations_[sample.station].add(sample, now_ns, air_log);
}

std::optional<BaseReference::Sample> BaseReference::reference_sample(std::size_t station,
                                                                     std::int64_t now_ns) const {
  if (state_ != State::kPresent || station != active_ || !usable(station, now_ns)) return std::nullopt;
  const BaseStation& source = stations_[station];
  if (!source.used_last()) return std::nullopt;
  return Sample{source.sample_log() + offset_log_[station], source.sample_variance()};
}

void BaseReference::restart_clock() {
  for (BaseStation& station : stations_) station.restart_clock();
  vote_.restart();
}

bool BaseReference::usable(std::size_t station, std::int64_t now_ns) const {
  return !condemned_[station] && stations_[station].ready(now_ns);
}

std::size_t BaseReference::usable_count(std::int64_t now_ns) const {
  return (usable(0, now_ns) ? 1 : 0) + (usable(1, now_ns) ? 1 : 0);
}

BarometerFault BaseReference::fault(std::size_t station, std::int64_t now_ns) const {
  const BarometerFault own = stations_[station].fault(now_ns);
  if (own == BarometerFault::kOk && condemned_[station]) return BarometerFault::kDrifting;
  return own;
}

double BaseReference::variance(std::int64_t now_ns) const {
  const double doubt_log = undecided_ ? divergence_log_ : 0.0;
  return stations_[active_].variance(now_ns) + squared(doubt_log);
}

// Index of the station to use as the reference; -1: none, hold the last pressure.
int BaseReference::choose(std::int64_t now_ns) const {
  const std::size_t other = 1 - active_;
  if (usable(active_, now_ns)) return static_cast<int>(active_);
  if (!usable(other, now_ns)) return -1;
  const bool wait = state_ == State::kPresent && !condemned_[active_] &&
                    seconds_between(good_ns_, now_ns) < kTakeOverS && !stations_[active_].lost(now_ns);
  return wait ? -1 : static_cast<int>(other);
}

void BaseReference::adopt(std::size_t station) {
  active_ = station;
  if (!offset_known_[station]) offset_log_[station] = log_pa_ - stations_[station].value();
  offset_known_[station] = true;
  divergence_log_ = 0.0;
  shift_log_ = stations_[station].value() + offset_log_[station] - log_pa_;
}

ReferenceEvent BaseReference::update(std::int64_t now_ns, double witness_log) {
  const double dt_s = std::clamp(seconds_between(updated_ns_, now_ns), 0.0, kLongestStepS);
  updated_ns_ = now_ns;
  compare(now_ns, dt_s, witness_log);
  const int chosen = choose(now_ns);
  if (chosen < 0) {
    const bool lost =
        stations_[active_].lost(now_ns) || seconds_between(good_ns_, now_ns) > config_.base_timeout_s;
    if (state_ != State::kPresent || !lost) return ReferenceEvent::kNone;
    state_ = State::kLost;
    return ReferenceEvent::kBaseLost;
  }
  const auto station = static_cast<std::size_t>(chosen);
  good_ns_ = now_ns;
  ReferenceEvent event = ReferenceEvent::kNone;
  if (state_ == State::kPresent && station != active_) event = ReferenceEvent::kBaseSwitched;
  if (state_ == State::kLost)
    event = offset_known_[station] ? ReferenceEvent::kBaseReturned : ReferenceEvent::kBaseJoined;
  if (state_ == State::kNever) event = ReferenceEvent::kBaseJoined;
  if (event != ReferenceEvent::kNone) adopt(station);
  state_ = State::kPresent;
  log_pa_ = stations_[station].value() + offset_log_[station];
  return event;
}

void BaseReference::compare(std::int64_t now_ns, double dt_s, double witness_log) {
  const bool both = stations_[0].ready(now_ns) && stations_[1].ready(now_ns);
  if (!both || state_ != State::kPresent) {
    undecided_ = false;
    return;
  }
  const std::size_t standby = 1 - active_;
  const double difference_log =
      stations_[standby].value() + offset_log_[standby] - (stations_[active_].value() + offset_log_[active_]);
  if (condemned_[0] || condemned_[1]) {
    stopped_s_ += dt_s;
    watch_condemned(difference_log);
    return;
  }
  learn_standby(difference_log, dt_s);
  const bool agree = std::abs(divergence_log_) < kFrozenShare * kDivergedPa / config_.max_pressure_pa;
  vote_.add(now_ns, {stations_[0].value(), stations_[1].value(), witness_log}, agree);
  const double limit_log = kDivergedPa / std::exp(stations_[active_].value());
  if (learnt_s_ < kOffsetLearntS || std::abs(divergence_log_) < limit_log) {
    undecided_ = false;
    return;
  }
  const int wrong = vote_.wrong();
  undecided_ = wrong < 0;
  if (undecided_) return;
  condemned_[static_cast<std::size_t>(wrong)] = true;
  stopped_log_ = difference_log;
  stopped_s_ = 0.0;
}

void BaseReference::learn_standby(double difference_log, double dt_s) {
  const std::size_t standby = 1 - active_;
  if (!offset_known_[standby]) {
    offset_log_[standby] -= difference_log;
    offset_known_[standby] = true;
    learnt_s_ = divergence_log_ = 0.0;
    vote_.restart();
    return;
  }
  divergence_log_ += (difference_log - divergence_log_) * -std::expm1(-dt_s / kDivergenceSmoothingS);
  const double frozen_log = kFrozenShare * kDivergedPa / std::exp(stations_[active_].value());
  if (learnt_s_ >= kOffsetLearntS && std::abs(divergence_log_) > frozen_log) return;
  const double memory_s = std::min(learnt_s_, kOffsetMemoryS);
  offset_log_[standby] -= difference_log * dt_s / (memory_s + kDivergenceSmoothingS);
  learnt_s_ += dt_s;
}

// Rehabilitates a condemned station whose difference has been constant for kStoppedS.
void BaseReference::watch_condemned(double difference_log) {
  const double limit_log = 0.5 * kDivergedPa / config_.max_pressure_pa;
  if (std::abs(difference_log - stopped_log_) > limit_log) {
    stopped_log_ = difference_log;
    stopped_s_ = 0.0;
  }
  if (stopped_s_ < kStoppedS) return;
  const std::size_t back = condemned_[0] ? 0 : 1;
  condemned_[back] = false;
  // The active station keeps its offset; only a standby learns a new one.
  if (back != active_) offset_known_[back] = false;
}

}  // namespace isobar
