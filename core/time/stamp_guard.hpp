// SPDX-License-Identifier: BSD-3-Clause
// Plausibility of a stream's stamps.
#pragma once

#include <cstdint>

namespace isobar {

/// Limits of StampGuard.
struct StampGuardConfig {
  /// Longest step forward that needs no confirmation by a second sample [ns].
  std::int64_t max_forward_ns = 2'000'000'000;
  /// Longest step backward of a sample overtaken in transport [ns]; a longer one needs confirmation.
  std::int64_t max_reorder_ns = 500'000'000;
};

/// Verdict on one stamp.
enum class StampVerdict : std::uint8_t {
  kAccept,     ///< newer than all before, by a regular step
  kDuplicate,  ///< the same stamp as the newest sample
  kReordered,  ///< a little older than the newest sample
  kHeld,       ///< jump: hold the sample, the next verdict decides
  kConfirmed,  ///< agrees with the held sample: the stream has jumped, both samples are good
};

/// Checks the stamps of one stream so that one absurd stamp cannot make later good samples look old.
///
/// A stream slower than max_forward_ns is recognised by its even steps; the limit then follows its interval.
///
/// Verdict after kHeld: kConfirmed, the held sample is good and comes before this one; kHeld with the same
/// stamp, a copy of the held one, which stays held; kHeld with another stamp, the held one was absurd and
/// this one is held instead; any other, the held one was absurd.
class StampGuard {
 public:
  explicit StampGuard(const StampGuardConfig& config = {})
      : max_forward_ns_(config.max_forward_ns), max_reorder_ns_(config.max_reorder_ns) {}

  StampVerdict check(std::int64_t stamp_ns);

  [[nodiscard]] std::int64_t newest_ns() const { return newest_ns_; }
  /// Counters since the start. Jumps are counted once confirmed: a gap, or a clock that was set.
  [[nodiscard]] std::uint64_t duplicates() const { return duplicates_; }
  [[nodiscard]] std::uint64_t reordered() const { return reordered_; }
  [[nodiscard]] std::uint64_t absurd() const { return absurd_; }
  [[nodiscard]] std::uint64_t gaps() const { return gaps_; }              ///< confirmed jumps forward
  [[nodiscard]] std::uint64_t steps_back() const { return steps_back_; }  ///< confirmed jumps backward

 private:
  [[nodiscard]] bool usual(std::int64_t from_ns, std::int64_t to_ns) const;
  StampVerdict confirm(std::int64_t stamp_ns);

  std::int64_t max_forward_ns_;  // grows with the interval of a slow stream
  std::int64_t max_reorder_ns_;
  bool started_ = false;
  bool holding_ = false;
  std::int64_t newest_ns_ = 0;
  std::int64_t held_ns_ = 0;
  std::uint64_t duplicates_ = 0;
  std::uint64_t reordered_ = 0;
  std::uint64_t absurd_ = 0;
  std::uint64_t gaps_ = 0;
  std::uint64_t steps_back_ = 0;
};

}  // namespace isobar
