// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/iio/buffer_device.hpp"

namespace isobar::iio {

/// Scans of a gyro and of an accelerometer on one clock to scans of both: the acceleration at the time of each rate, between
/// the two that are around it. Scans of a common trigger have equal times and wait for nothing. Allocates nothing.
class ScanPairs {
 public:
  /// Scans of each that wait for the other: 0.25 s at 1 kHz. Beyond it the oldest is lost.
  static constexpr std::size_t kMostWaiting = 256;
  /// Longest time between two accelerations over which is interpolated [ns].
  static constexpr std::int64_t kLongestGapNs = 50'000'000;

  void clear() noexcept;
  void add_gyro(const InertialScan& scan) noexcept { gyro_.push(scan); }
  void add_accel(const InertialScan& scan) noexcept { accel_.push(scan); }
  /// Takes the oldest scan of both; false: more of one of them is needed.
  bool next(InertialScan& scan) noexcept;
  [[nodiscard]] bool gyro_waits() const noexcept { return gyro_.count > 0; }
  /// Both have come, but more than a second apart: their clocks differ.
  [[nodiscard]] bool clocks_differ() const noexcept { return clocks_differ_; }

 private:
  struct Queue {
    std::array<InertialScan, kMostWaiting> scans{};
    std::size_t first = 0;
    std::size_t count = 0;

    void push(const InertialScan& scan) noexcept {
      if (count == kMostWaiting) pop();
      scans[(first + count++) % kMostWaiting] = scan;
    }
    void pop() noexcept {
      first = (first + 1) % kMostWaiting;
      --count;
    }
    [[nodiscard]] const InertialScan& at(std::size_t index) const noexcept {
      return scans[(first + index) % kMostWaiting];
    }
  };

  Queue gyro_, accel_;
  bool clocks_differ_ = false;
};

}  // namespace isobar::iio
