// SPDX-License-Identifier: BSD-3-Clause
// Fault detection shared by all devices: current fault, since when, and time of the next try.
#pragma once

#include <cstdint>

#include "drivers/device/device.hpp"

namespace isobar {

/// Detector of frozen results. Noise of air and converter moves the last bits of every 24 bit result:
/// kMinEqual equal ones in a row happen by chance once in years.
class StuckWatch {
 public:
  static constexpr std::uint64_t kMinEqual = 16;

  /// @param time_ns shortest time without a change that is a fault; 0: no detection (a coarse converter in
  ///         calm air)
  explicit StuckWatch(std::int64_t time_ns) : time_ns_(time_ns) {}

  /// Adds a result; true while the results are stuck. Keeps its history across initialisations of the device:
  /// a sensor that is still stuck after a reset is detected at once.
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

/// State, fault text, counters, and the back-off before the next try: 0.1 s, doubled up to a limit.
class FaultWatch {
 public:
  /// Limit of the back-off [ns]: shorter than the silence after which a thread counts as hung (WorkerGroup,
  /// 5 s).
  static constexpr std::int64_t kLongestWaitNs = 4'000'000'000;

  /// @param longest_wait_ns limit of the back-off, at most kLongestWaitNs; short where a sensor must be back
  ///         soon after its return and a try costs little
  explicit FaultWatch(std::int64_t silence_ns, std::int64_t longest_wait_ns = kLongestWaitNs)
      : silence_ns_(silence_ns), longest_wait_ns_(longest_wait_ns) {}

  /// An initialisation begins.
  void starts(std::int64_t now_ns) noexcept;
  /// The device begins to measure: the time to the first result counts from now_ns.
  void expects_results(std::int64_t now_ns) noexcept;
  /// A good result: clears the fault.
  void good(std::int64_t now_ns) noexcept;
  /// A failed access or a bad result. It becomes a fault when no good result follows in time.
  void problem(DeviceState state, const char* what, int error = 0) noexcept;
  /// Sets the fault.
  /// @return time of the next try
  std::int64_t fail(DeviceState state, const char* what, std::int64_t now_ns, int error = 0) noexcept;
  /// True when no good result came in time: the caller then calls give_up() and restarts the device.
  [[nodiscard]] bool overdue(std::int64_t now_ns) const noexcept {
    return now_ns - newest_good_ns_ > silence_ns_;
  }
  /// fail() with the last problem, or silence when there was none.
  std::int64_t give_up(std::int64_t now_ns) noexcept;

  [[nodiscard]] const DeviceStatus& status() const noexcept { return status_; }
  [[nodiscard]] DeviceCounters& counters() noexcept { return status_.counters; }
  /// Sets DeviceStatus::note; nullptr: none.
  void note(const char* what) noexcept;

 private:
  void set_fault(DeviceState state, const char* what, int error) noexcept;

  static constexpr std::int64_t kFirstWaitNs = 100'000'000;
  /// Duration of good results after which the back-off starts again at kFirstWaitNs.
  static constexpr std::int64_t kWellNs = 2'000'000'000;

  std::int64_t silence_ns_;
  std::int64_t longest_wait_ns_;
  std::int64_t newest_good_ns_ = 0;
  std::int64_t good_since_ns_ = 0;
  std::int64_t wait_ns_ = kFirstWaitNs;
  DeviceState problem_state_ = DeviceState::kSilent;
  const char* problem_ = nullptr;
  int problem_error_ = 0;
  DeviceStatus status_;
};

}  // namespace isobar
