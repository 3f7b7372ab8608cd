// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/base_reference.hpp"

#include <algorithm>
#include <cmath>

#include "core/stamp.hpp"

namespace isobar {
namespace {

// Another station takes over when the reference has been unusable for this long: longer than a gust.
constexpr double kTakeOverS = 1.5;
// Memory of the standby's offset, and how long it must have been learnt before a difference means anything
// [s]. The warm-up of a station, 0.6 Pa within minutes, is learnt along.
constexpr double kOffsetMemoryS = 300.0;
constexpr double kOffsetLearntS = 20.0;
// Low-pass of the difference of two stations: turbulence of 0.2 Pa over seconds goes down to 0.1 Pa.
constexpr double kPartedSmoothingS = 3.0;
// Stations that part by more than this are wrong [Pa]: more than ten sigmas of that, and 13 cm.
constexpr double kPartedPa = 1.5;
// From this share of it on the offset is no longer learnt: a drift must not be learnt away.
constexpr double kFrozenShare = 0.4;
// A condemned station that has stood still for this long is good again, with a new offset.
constexpr double kStoppedS = 120.0;
constexpr double kLongestStepS = 1.0;

}  // namespace

BaseReference::BaseReference(const AltimeterConfig& config)
    : config_(config), stations_{BaseStation(config), BaseStation(config)} {}

PressureStatus BaseReference::add(const PressureSample& sample, std::int64_t now_ns) {
  if (sample.station >= kStations) return PressureStatus::kBadValue;
  return stations_[sample.station].add(sample, now_ns);
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
  const BarometerFault seen = stations_[station].fault(now_ns);
  if (seen == BarometerFault::kOk && condemned_[station]) return BarometerFault::kDrifting;
  return seen;
}

double BaseReference::variance(std::int64_t now_ns) const {
  const double doubt = undecided_ ? parted_log_ : 0.0;
  return stations_[active_].variance(now_ns) + doubt * doubt;
}

// The station to measure against, -1 to hold.
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
  parted_log_ = 0.0;
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
  const bool agree = std::abs(parted_log_) < kFrozenShare * kPartedPa / config_.max_pressure_pa;
  vote_.add(now_ns, {stations_[0].value(), stations_[1].value(), witness_log}, agree);
  const double limit_log = kPartedPa / std::exp(stations_[active_].value());
  if (learnt_s_ < kOffsetLearntS || std::abs(parted_log_) < limit_log) {
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
    learnt_s_ = parted_log_ = 0.0;
    vote_.restart();
    return;
  }
  parted_log_ += (difference_log - parted_log_) * -std::expm1(-dt_s / kPartedSmoothingS);
  const double frozen_log = kFrozenShare * kPartedPa / std::exp(stations_[active_].value());
  if (learnt_s_ >= kOffsetLearntS && std::abs(parted_log_) > frozen_log) return;
  const double memory_s = std::min(learnt_s_, kOffsetMemoryS);
  offset_log_[standby] -= difference_log * dt_s / (memory_s + kPartedSmoothingS);
  learnt_s_ += dt_s;
}

// A station that has drifted and then stands still again for long is as good as a new one.
void BaseReference::watch_condemned(double difference_log) {
  const double limit_log = 0.5 * kPartedPa / config_.max_pressure_pa;
  if (std::abs(difference_log - stopped_log_) > limit_log) {
    stopped_log_ = difference_log;
    stopped_s_ = 0.0;
  }
  if (stopped_s_ < kStoppedS) return;
  const std::size_t back = condemned_[0] ? 0 : 1;
  condemned_[back] = false;
  // Of the two, the one that was kept is the reference still.
  if (back != active_) offset_known_[back] = false;
}

}  // namespace isobar
