// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// What a stream of stamps may look like.
struct StampGuardConfig {
  /// A step forward longer than this is suspicious until a second sample confirms it [ns].
  std::int64_t max_forward_ns = 2'000'000'000;
  /// A step backward up to this long is a sample that was overtaken on its way; longer is suspicious [ns].
  std::int64_t max_reorder_ns = 500'000'000;
};

enum class StampVerdict : std::uint8_t {
  kAccept,     ///< newer than all before, by a usual step
  kDuplicate,  ///< the same stamp as the newest sample
  kReordered,  ///< a little older than the newest sample
  kHeld,       ///< jumped: keep the sample aside, the next verdict decides
  kConfirmed,  ///< agrees with the held sample: the stream has moved there, both samples are good
};

/// Watches the stamps of one stream, so that one absurd stamp can never make later good samples look old.
///
/// A stream slower than max_forward_ns is recognised by its even steps, and the limit then follows its
/// cadence.
///
/// After kHeld: kConfirmed says that the held sample was good (take it before this one); kHeld says that the
/// held one was absurd and that this one is now in question; any other verdict says that the held one was
/// absurd.
class StampGuard {
 public:
  explicit StampGuard(const StampGuardConfig& config = {})
      : max_forward_ns_(config.max_forward_ns), max_reorder_ns_(config.max_reorder_ns) {}

  StampVerdict check(std::int64_t stamp_ns);

  [[nodiscard]] std::int64_t newest_ns() const { return newest_ns_; }
  /// Counters since the start. A jump is a confirmed one: a gap, or a clock that was set.
  [[nodiscard]] std::uint64_t duplicates() const { return duplicates_; }
  [[nodiscard]] std::uint64_t reordered() const { return reordered_; }
  [[nodiscard]] std::uint64_t absurd() const { return absurd_; }
  [[nodiscard]] std::uint64_t gaps() const { return gaps_; }              ///< confirmed jumps forward
  [[nodiscard]] std::uint64_t steps_back() const { return steps_back_; }  ///< confirmed jumps backward

 private:
  [[nodiscard]] bool usual(std::int64_t from_ns, std::int64_t to_ns) const;
  StampVerdict confirm(std::int64_t stamp_ns);

  std::int64_t max_forward_ns_;  // grows with the cadence of a slow stream
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
