// SPDX-License-Identifier: BSD-3-Clause
// The robot's pressure of the last seconds, with its motion subtracted or not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Ring of the robot's pressures and of the climb that belongs to them: what a base station's delayed sample is
/// compared with. Linear interpolation: at 32 Hz a gust of 3 Pa at 0.2 Hz is met to 0.6 mPa.
class RobotAir {
 public:
  /// Shortest spacing of the entries [s]; with kEntries they reach back 5 s, the largest transport delay.
  static constexpr double kSpacingS = 0.01;
  static constexpr std::size_t kEntries = 512;

  struct Value {
    double log_pa = 0.0;       ///< ln of the pressure [Pa]
    double climb_m = 0.0;      ///< climb of the port by inertial sensors and wheels [m]
    double noise_share = 1.0;  ///< variance of log_pa as a share of one sample's: (1 - a)^2 + a^2
  };

  /// Stamps must ascend; an entry closer than kSpacingS to the one before is left out.
  void add(std::int64_t stamp_ns, double log_pa, double climb_m);
  void restart() { count_ = 0; }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// A sample at or after this time has come.
  [[nodiscard]] bool reaches(std::int64_t stamp_ns) const {
    return count_ > 0 && entry(count_ - 1).stamp_ns >= stamp_ns;
  }
  /// The oldest sample is not after this time.
  [[nodiscard]] bool remembers(std::int64_t stamp_ns) const {
    return count_ > 0 && entry(0).stamp_ns <= stamp_ns;
  }
  /// Value at that time; outside of the remembered time that of its end. Not when empty.
  [[nodiscard]] Value at(std::int64_t stamp_ns) const;

 private:
  struct Entry {
    std::int64_t stamp_ns = 0;
    double log_pa = 0.0;
    double climb_m = 0.0;
  };

  /// `age_rank`: 0 is the oldest.
  [[nodiscard]] const Entry& entry(std::size_t age_rank) const {
    return entries_[(next_ + kEntries - count_ + age_rank) % kEntries];
  }

  std::array<Entry, kEntries> entries_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace isobar
