// SPDX-License-Identifier: BSD-3-Clause
#include "core/time/base_station_stream.hpp"

#include <algorithm>
#include <bit>

namespace isobar {
namespace {

/// Largest sample interval: base stations may send every few seconds.
constexpr std::int64_t kMaxCadenceNs = 10'000'000'000;
/// Silence of the candidate after which another sender may become the candidate: only one is confirmed at a
/// time.
constexpr std::int64_t kCandidateSilenceNs = 5'000'000'000;

ClockAnchor new_anchor() {
  ClockAnchorConfig config;
  config.max_cadence_ns = kMaxCadenceNs;
  return ClockAnchor(config);
}

}  // namespace

BaseStationStream::BaseStationStream(const BaseStationConfig& config) : config_(config) {}

void BaseStationStream::Clock::add(std::int64_t stamp_ns, std::int64_t receive_ns) noexcept {
  if (samples == 0) {
    anchor = new_anchor();
    first_ns = stamp_ns;
    first_receive_ns = receive_ns;
  }
  static_cast<void>(anchor.add(stamp_ns, receive_ns));
  newest_ns = stamp_ns;
  newest_receive_ns = receive_ns;
  ++samples;
}

BaseVerdict BaseStationStream::check(std::uint64_t sender, PressureSample& sample, std::int64_t receive_ns,
                                     const SystemClockWatch* system) noexcept {
  const std::uint64_t print = fingerprint(sample);  // of the stamp as sent
  if (system != nullptr) {
    sample.stamp_ns = without_steps_ns(sender, sample.stamp_ns, receive_ns, *system);
  }
  const BaseVerdict verdict = verdict_on(sender, sample, print, receive_ns);
  if (verdict == BaseVerdict::kAccepted) accept(sample, print, receive_ns);
  ++status_.samples[static_cast<std::size_t>(verdict)];
  return verdict;
}

std::int64_t BaseStationStream::without_steps_ns(std::uint64_t sender, std::int64_t stamp_ns,
                                                 std::int64_t receive_ns,
                                                 const SystemClockWatch& system) noexcept {
  Clock& clock = sender == clock_.sender ? clock_ : sender == previous_.sender ? previous_ : candidate_;
  const bool continues = clock.samples > 0 && clock.sender == sender;
  return clock.steps.without_steps_ns(stamp_ns, receive_ns - clock.anchor.offset_ns(), continues, system);
}

BaseVerdict BaseStationStream::verdict_on(std::uint64_t sender, const PressureSample& sample,
                                          std::uint64_t print, std::int64_t receive_ns) noexcept {
  if (!cadence_.started()) {
    clock_.sender = sender;
    clock_.steps = candidate_.steps;
    return BaseVerdict::kAccepted;
  }
  if (returns(sender, sample.stamp_ns, receive_ns) && !remembers(print)) take_back();
  const bool is_new = sender != clock_.sender;
  if (is_new && !may_follow(sender, receive_ns)) {
    note_rival(sender, receive_ns);
    return BaseVerdict::kOtherSender;
  }
  if (remembers(print)) {
    // A sender that replays one sample may replay its neighbours: restart its confirmation.
    if (candidate_.sender == sender) candidate_.samples = 0;
    return BaseVerdict::kRepeated;
  }
  const BaseVerdict verdict = is_new ? BaseVerdict::kUnconfirmed : judge(clock_, sample.stamp_ns, receive_ns);
  if (verdict == BaseVerdict::kAccepted || !confirms(sender, sample.stamp_ns, receive_ns)) return verdict;
  replace(is_new);
  return BaseVerdict::kAccepted;
}

void BaseStationStream::replace(bool is_new) noexcept {
  ++(is_new ? status_.restarts : status_.clock_steps);
  if (is_new) {
    previous_ = clock_;
    cadence_.restart();
    left_ = false;
    rivals_ = {};
    next_rival_ = 0;
  } else {
    candidate_.steps = clock_.steps;
  }
  clock_ = candidate_;
}

bool BaseStationStream::returns(std::uint64_t sender, std::int64_t stamp_ns,
                                std::int64_t receive_ns) const noexcept {
  return previous_.samples > 0 && sender == previous_.sender && sender != clock_.sender &&
         judge(previous_, stamp_ns, receive_ns) == BaseVerdict::kAccepted;
}

// The usurper is now known as another base station beside this one.
void BaseStationStream::take_back() noexcept {
  ++status_.returns;
  rivals_ = {};
  rivals_[0] = {clock_.sender, true, true};
  next_rival_ = 1;
  clock_ = previous_;
  previous_.samples = 0;
  candidate_.samples = 0;
  cadence_.restart();
  left_ = false;
}

const BaseStationStream::Rival* BaseStationStream::find_rival(std::uint64_t sender) const noexcept {
  const auto found = std::find_if(rivals_.begin(), rivals_.end(), [sender](const Rival& rival) {
    return rival.known && rival.sender == sender;
  });
  return found != rivals_.end() ? &*found : nullptr;
}

bool BaseStationStream::may_follow(std::uint64_t sender, std::int64_t receive_ns) const noexcept {
  const bool other_is_watched = candidate_.samples > 0 && candidate_.sender != sender &&
                                receive_ns - candidate_.newest_receive_ns <= kCandidateSilenceNs;
  if (other_is_watched) return false;
  const Rival* rival = find_rival(sender);
  const bool is_beside = rival != nullptr && rival->is_beside;
  if (!is_beside && left_) return true;
  const std::int64_t silence_ns = is_beside ? config_.takeover_ns : config_.replace_ns;
  return receive_ns - cadence_.last_ns() > std::max(silence_ns, cadence_.limit_ns());
}

void BaseStationStream::note_rival(std::uint64_t sender, std::int64_t receive_ns) noexcept {
  if (const Rival* rival = find_rival(sender); rival != nullptr) {
    if (rival->is_beside) status_.rival_ns = receive_ns;
    return;
  }
  rivals_[next_rival_] = {sender, true, false};
  next_rival_ = (next_rival_ + 1) % kRivals;
}

BaseVerdict BaseStationStream::judge(const Clock& clock, std::int64_t stamp_ns,
                                     std::int64_t receive_ns) const noexcept {
  const std::int64_t late_ns = clock.lateness_ns(stamp_ns, receive_ns);
  if (stamp_ns <= clock.newest_ns) return BaseVerdict::kOutdated;
  if (late_ns < -config_.max_early_ns) return BaseVerdict::kAhead;
  return late_ns > config_.max_age_ns ? BaseVerdict::kTooOld : BaseVerdict::kAccepted;
}

bool BaseStationStream::confirms(std::uint64_t sender, std::int64_t stamp_ns,
                                 std::int64_t receive_ns) noexcept {
  const std::int64_t late_ns = candidate_.lateness_ns(stamp_ns, receive_ns);
  if (candidate_.sender != sender || stamp_ns <= candidate_.newest_ns || late_ns > config_.agreement_ns ||
      late_ns < -config_.agreement_ns) {
    candidate_.samples = 0;
  }
  candidate_.sender = sender;
  candidate_.add(stamp_ns, receive_ns);
  return candidate_.samples >= config_.confirm_samples &&
         stamp_ns - candidate_.first_ns >= config_.confirm_ns &&
         receive_ns - candidate_.first_receive_ns >= config_.confirm_ns;
}

void BaseStationStream::accept(PressureSample& sample, std::uint64_t print,
                               std::int64_t receive_ns) noexcept {
  // The clock of a confirmed candidate already contains this sample.
  if (clock_.samples == 0 || clock_.newest_ns != sample.stamp_ns) clock_.add(sample.stamp_ns, receive_ns);
  candidate_.samples = 0;
  for (Rival& rival : rivals_) rival.is_beside = rival.known;
  status_.outages += cadence_.silent(receive_ns) || left_ ? 1 : 0;
  left_ = false;
  cadence_.add(receive_ns);
  remember(print);
  // A lowered offset could map this stamp before the previous one: keep stamps ascending.
  newest_robot_ns_ =
      std::max(clock_.anchor.to_host_ns(clock_.anchor.device_unwrapped_ns()), newest_robot_ns_ + 1);
  sample.stamp_ns = newest_robot_ns_;
  sample.timing = {receive_ns, clock_.anchor.device_ahead_ns()};
}

void BaseStationStream::sender_gone(std::uint64_t sender) noexcept {
  if (cadence_.started() && sender == clock_.sender) left_ = true;
}

BaseStationStatus BaseStationStream::status() const noexcept {
  BaseStationStatus status = status_;
  status.last_ns = cadence_.last_ns();
  status.interval_ns = cadence_.interval_ns();
  status.limit_ns = cadence_.limit_ns();
  status.clock_ahead_ns = clock_.samples > 0 ? -clock_.anchor.offset_ns() : 0;
  status.left = left_;
  return status;
}

std::uint64_t BaseStationStream::fingerprint(const PressureSample& sample) noexcept {
  // Two rounds of a multiplicative hash: spreads neighbouring stamps over the buckets.
  constexpr std::uint64_t kOdd = 0x9E37'79B9'7F4A'7C15ULL;
  std::uint64_t print = static_cast<std::uint64_t>(sample.stamp_ns) * kOdd;
  print ^= print >> 32U;
  print = (print ^ std::bit_cast<std::uint64_t>(sample.pressure_pa)) * kOdd;
  print ^= print >> 29U;
  return print | std::uint64_t{1} << 63U;  // never 0: an empty place
}

bool BaseStationStream::remembers(std::uint64_t print) const noexcept {
  const auto& prints = memory_[print % kBuckets].prints;
  return std::find(prints.begin(), prints.end(), print) != prints.end();
}

void BaseStationStream::remember(std::uint64_t print) noexcept {
  Bucket& bucket = memory_[print % kBuckets];
  bucket.prints[bucket.next] = print;
  bucket.next = static_cast<std::uint8_t>((bucket.next + 1U) % bucket.prints.size());
}

}  // namespace isobar
