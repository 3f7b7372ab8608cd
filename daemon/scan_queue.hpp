// SPDX-License-Identifier: BSD-3-Clause
// Admission of scans to the registration: which scan is next, and which are dropped.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace isobar {

/// Which waiting scans are admitted.
enum class ScanAdmission : std::uint8_t {
  kNewest,  ///< live: the newest admissible scan; older ones are dropped, freshness wins
  kEvery,   ///< lock step: every scan in order, none dropped
};

/// When a scan is admissible: once priors reach its end.
struct ScanQueueConfig {
  std::int64_t reach_ns =
      6'000'000;  ///< largest age of the newest prior, counted back from the end of the scan
  std::int64_t wait_ns = 50'000'000;  ///< longest wait for priors after the arrival of the scan
  ScanAdmission admission = ScanAdmission::kNewest;
};

/// A scan that is not registered: superseded by a newer one, or lost before it reached this queue.
struct DroppedScan {
  std::int64_t end_stamp_ns = 0;  ///< its own; of a lost scan: interpolated between its neighbours
  std::uint32_t sequence = 0;
};

/// Scans that wait for their priors or for the registration. Dropped and lost scans are counted and listed,
/// so that their poses can come from the prior. `Handle`: movable pointer to a scan (members `sequence` and
/// `end_stamp_ns`), empty when default-constructed. Allocates nothing. One thread.
template <class Handle>
class ScanQueue {
 public:
  /// Capacity for kNewest: each waiting scan holds a chunk of shared memory.
  static constexpr std::size_t kMaxWaiting = 3;
  /// Capacity for kEvery: reached only while the IMU is silent.
  static constexpr std::size_t kMaxWaitingEvery = 5;
  /// Length of the list of dropped scans, the newest ones: 3 s of a lidar at 10 Hz. All are counted.
  static constexpr std::size_t kMaxListed = 32;

  explicit ScanQueue(const ScanQueueConfig& config) : config_(config) {}

  /// Changes reach and wait for the scans that wait and all later ones; not the admission.
  void configure(const ScanQueueConfig& config) noexcept {
    config_.reach_ns = config.reach_ns;
    config_.wait_ns = config.wait_ns;
  }

  /// Adds a scan that arrived at `now_ns`; in order. kNewest: a full queue drops its oldest scan. kEvery:
  /// call take() until it returns empty before the next push(), so that the queue is never full here.
  void push(Handle scan, std::int64_t now_ns) noexcept {
    if (count_ == capacity()) drop_oldest();
    Waiting& place = waiting_[count_++];
    const std::uint32_t step = scan->sequence - last_.sequence;
    place.before = last_;
    place.arrived_ns = now_ns;
    place.missing = started_ && step > 1 && step < kMaxMissing ? step - 1 : 0;
    last_ = {scan->end_stamp_ns, scan->sequence};
    started_ = true;
    place.scan = std::move(scan);
  }

  /// The scan to register now; empty when none is admissible. kNewest: the newest admissible scan, and all
  /// older ones are dropped. kEvery: the oldest scan, once it is admissible or the queue is full.
  [[nodiscard]] Handle take(std::int64_t now_ns, std::int64_t newest_prior_ns) noexcept {
    if (config_.admission == ScanAdmission::kEvery) {
      const bool due =
          count_ == capacity() || (count_ > 0 && admissible(waiting_[0], now_ns, newest_prior_ns));
      return due ? pop_oldest() : Handle{};
    }
    for (std::size_t newest = count_; newest-- > 0;) {
      if (!admissible(waiting_[newest], now_ns, newest_prior_ns)) continue;
      for (std::size_t older = 0; older < newest; ++older) drop_oldest();
      return pop_oldest();
    }
    return {};
  }

  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }

  /// Scans dropped or lost since forget_dropped(), in order of
  /// time, all older than the scan that take() returned last.
  [[nodiscard]] std::span<const DroppedScan> dropped() const noexcept {
    return {listed_.data(), listed_count_};
  }
  void forget_dropped() noexcept { listed_count_ = 0; }
  /// All scans ever dropped or lost.
  [[nodiscard]] std::uint64_t dropped_count() const noexcept { return dropped_count_; }

 private:
  /// Largest step of the sequence number that counts as loss; a larger one is a restart of the lidar thread.
  static constexpr std::uint32_t kMaxMissing = 1U << 16U;

  struct Waiting {
    Handle scan{};
    std::int64_t arrived_ns = 0;
    DroppedScan before{};       // its predecessor
    std::uint32_t missing = 0;  // scans lost between the two
  };

  [[nodiscard]] std::size_t capacity() const noexcept {
    return config_.admission == ScanAdmission::kEvery ? kMaxWaitingEvery : kMaxWaiting;
  }

  [[nodiscard]] bool admissible(const Waiting& place, std::int64_t now_ns,
                                std::int64_t newest_prior_ns) const noexcept {
    return newest_prior_ns >= place.scan->end_stamp_ns - config_.reach_ns ||
           now_ns >= place.arrived_ns + config_.wait_ns;
  }

  void list(const DroppedScan& scan) noexcept {
    ++dropped_count_;
    if (listed_count_ == kMaxListed) {
      std::move(listed_.begin() + 1, listed_.end(), listed_.begin());
      --listed_count_;
    }
    listed_[listed_count_++] = scan;
  }

  // Revolutions take equal times, so the ends of lost scans are equally spaced.
  void list_missing(const Waiting& place) noexcept {
    const std::int64_t span_ns = place.scan->end_stamp_ns - place.before.end_stamp_ns;
    for (std::uint32_t i = 1; i <= place.missing; ++i) {
      list({place.before.end_stamp_ns + span_ns * i / (place.missing + 1), place.before.sequence + i});
    }
  }

  Handle pop_oldest() noexcept {
    list_missing(waiting_[0]);
    Handle scan = std::move(waiting_[0].scan);
    std::move(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(count_), waiting_.begin());
    --count_;
    return scan;
  }

  void drop_oldest() noexcept {
    const Handle scan = pop_oldest();
    list({scan->end_stamp_ns, scan->sequence});
  }

  ScanQueueConfig config_;
  std::array<Waiting, kMaxWaitingEvery> waiting_{};
  std::size_t count_ = 0;
  DroppedScan last_{};  // the newest scan that was pushed
  bool started_ = false;
  std::array<DroppedScan, kMaxListed> listed_{};
  std::size_t listed_count_ = 0;
  std::uint64_t dropped_count_ = 0;
};

}  // namespace isobar
