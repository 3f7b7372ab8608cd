// SPDX-License-Identifier: BSD-3-Clause
// Which scan is registered next, and which never: freshness wins.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace isobar {

/// When a scan may be registered. It asks for the priors up to its end.
struct ScanQueueConfig {
  std::int64_t reach_ns = 6'000'000;  ///< the newest prior may be so much older than the end of the scan
  std::int64_t wait_ns = 50'000'000;  ///< so long after it came a scan goes on with the priors that there are
};

/// A scan that is not registered: it came too late, or it never reached this thread.
struct DroppedScan {
  std::int64_t end_stamp_ns = 0;  ///< its own, or between its neighbours' where it never came
  std::uint32_t sequence = 0;
};

/// Scans that wait for their priors or for the registration. When several could be registered only the newest
/// is: the older ones are dropped, counted and told, so that their poses can be made from the prior. `Handle`
/// is a movable pointer to something with `sequence` and `end_stamp_ns`; empty when default-constructed.
/// Allocates nothing. One thread.
template <class Handle>
class ScanQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 3;
  /// More dropped scans than these are counted, but only the newest are told: 3 s of a lidar at 10 Hz.
  static constexpr std::size_t kMaxTold = 32;

  explicit ScanQueue(const ScanQueueConfig& config) : config_(config) {}

  /// Takes a scan that came now; they come in order. When too many wait the oldest is dropped.
  void push(Handle scan, std::int64_t now_ns) noexcept {
    if (count_ == kMaxWaiting) drop_oldest();
    Waiting& place = waiting_[count_++];
    const std::uint32_t step = scan->sequence - last_.sequence;
    place.before = last_;
    place.came_ns = now_ns;
    place.missing = started_ && step > 1 && step < kMostMissing ? step - 1 : 0;
    last_ = {scan->end_stamp_ns, scan->sequence};
    started_ = true;
    place.scan = std::move(scan);
  }

  /// The scan to register now, the newest of those that may be; empty where none may. All older ones are
  /// dropped.
  [[nodiscard]] Handle take(std::int64_t now_ns, std::int64_t newest_prior_ns) noexcept {
    for (std::size_t newest = count_; newest-- > 0;) {
      const std::int64_t end_ns = waiting_[newest].scan->end_stamp_ns;
      if (newest_prior_ns < end_ns - config_.reach_ns &&
          now_ns < waiting_[newest].came_ns + config_.wait_ns) {
        continue;
      }
      for (std::size_t older = 0; older < newest; ++older) drop_oldest();
      return pop_oldest();
    }
    return {};
  }

  /// No scan waits.
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

  /// What was dropped since forget_dropped(), in order of time, all of it older than what take() gave last.
  [[nodiscard]] std::span<const DroppedScan> dropped() const noexcept { return {told_.data(), told_count_}; }
  void forget_dropped() noexcept { told_count_ = 0; }
  /// All that were ever dropped.
  [[nodiscard]] std::uint64_t dropped_count() const noexcept { return dropped_count_; }

 private:
  /// A larger step of the numbers is no loss but another beginning.
  static constexpr std::uint32_t kMostMissing = 1U << 16U;

  struct Waiting {
    Handle scan{};
    std::int64_t came_ns = 0;
    DroppedScan before{};       // the scan that came before it
    std::uint32_t missing = 0;  // between the two
  };

  void tell(const DroppedScan& scan) noexcept {
    ++dropped_count_;
    if (told_count_ == kMaxTold) {
      std::move(told_.begin() + 1, told_.end(), told_.begin());
      --told_count_;
    }
    told_[told_count_++] = scan;
  }

  // Revolutions last equally long, so those that never came ended at equal distances.
  void tell_missing(const Waiting& place) noexcept {
    const std::int64_t span_ns = place.scan->end_stamp_ns - place.before.end_stamp_ns;
    for (std::uint32_t i = 1; i <= place.missing; ++i) {
      tell({place.before.end_stamp_ns + span_ns * i / (place.missing + 1), place.before.sequence + i});
    }
  }

  Handle pop_oldest() noexcept {
    tell_missing(waiting_[0]);
    Handle scan = std::move(waiting_[0].scan);
    std::move(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(count_), waiting_.begin());
    --count_;
    return scan;
  }

  void drop_oldest() noexcept {
    const Handle scan = pop_oldest();
    tell({scan->end_stamp_ns, scan->sequence});
  }

  ScanQueueConfig config_;
  std::array<Waiting, kMaxWaiting> waiting_{};
  std::size_t count_ = 0;
  DroppedScan last_{};  // that was pushed
  bool started_ = false;
  std::array<DroppedScan, kMaxTold> told_{};
  std::size_t told_count_ = 0;
  std::uint64_t dropped_count_ = 0;
};

}  // namespace isobar
