// SPDX-License-Identifier: BSD-3-Clause
// The book-keeping that all barometers on this machine share: what is wrong, since when, and when to try
// again.
#pragma once

#include <cstdint>

#include "drivers/barometer/barometer_device.hpp"

namespace isobar {

/// Notices a result whose bits no longer change. Real air and a converter's own noise move the last bits of a
/// 24 bit result all the time: sixteen equal ones in a row come by chance once in years.
class StuckWatch {
 public:
  static constexpr std::uint64_t kMinEqual = 16;

  /// time_ns: how long a result must not change at least; 0: never stuck (a coarse converter in calm air).
  explicit StuckWatch(std::int64_t time_ns) : time_ns_(time_ns) {}

  /// True while the results are stuck. Remembers across initialisations of the device: one that is still
  /// stuck after a reset is so at once.
  bool add(std::int64_t bits, std::int64_t now_ns) noexcept {
    if (equal_ == 0 || bits != bits_) {
      bits_ = bits;
      since_ns_ = now_ns;
      equal_ = 0;
    }
    ++equal_;
    return time_ns_ > 0 && equal_ >= kMinEqual && now_ns - since_ns_ >= time_ns_;
  }

 private:
  std::int64_t time_ns_;
  std::int64_t bits_ = 0;
  std::int64_t since_ns_ = 0;
  std::uint64_t equal_ = 0;
};

/// State, fault text, counters and the waiting time before the next try: 0.1 s, doubled up to 5 s.
class FaultWatch {
 public:
  explicit FaultWatch(std::int64_t silence_ns) : silence_ns_(silence_ns) {}

  /// An initialisation begins.
  void starts(std::int64_t now_ns) noexcept;
  /// The device measures from now on: its first result is due.
  void expects_results(std::int64_t now_ns) noexcept;
  /// A good result: whatever was wrong is over.
  void good(std::int64_t now_ns) noexcept;
  /// Something is wrong with this access or result; it is a fault only if nothing good comes in time.
  void problem(BarometerState state, const char* what, int error = 0) noexcept;
  /// The device is given up until the time that is returned.
  std::int64_t fail(BarometerState state, const char* what, std::int64_t now_ns, int error = 0) noexcept;
  /// True when nothing good came in time. Then the caller tries anew at give_up().
  [[nodiscard]] bool overdue(std::int64_t now_ns) const noexcept {
    return now_ns - newest_good_ns_ > silence_ns_;
  }
  /// As fail(), with the last problem as the reason, or silence.
  std::int64_t give_up(std::int64_t now_ns) noexcept;

  [[nodiscard]] const BarometerStatus& status() const noexcept { return status_; }
  [[nodiscard]] BarometerCounters& counters() noexcept { return status_.counters; }

 private:
  void set_fault(BarometerState state, const char* what, int error) noexcept;

  static constexpr std::int64_t kFirstWaitNs = 100'000'000;
  static constexpr std::int64_t kLongestWaitNs = 5'000'000'000;
  /// A device that measured for this long was well: the next fault is a new one.
  static constexpr std::int64_t kWellNs = 2'000'000'000;

  std::int64_t silence_ns_;
  std::int64_t newest_good_ns_ = 0;
  std::int64_t good_since_ns_ = 0;
  std::int64_t wait_ns_ = kFirstWaitNs;
  BarometerState problem_state_ = BarometerState::kSilent;
  const char* problem_ = nullptr;
  int problem_error_ = 0;
  BarometerStatus status_;
};

}  // namespace isobar
