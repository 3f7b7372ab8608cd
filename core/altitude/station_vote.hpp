// SPDX-License-Identifier: BSD-3-Clause
// Two base stations have parted: which of them is wrong?
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Three barometers, of which at most one is wrong: two base stations and the robot's own, brought to one
/// height by wheels and attitude. What two of them agree on has happened. Where the robot cannot say (no
/// wheels, an elevator), a station is wrong that has moved faster than any weather.
class StationVote {
 public:
  /// ln of the three pressures; the robot's is NaN where its height is not known.
  struct Sample {
    double first_log = 0.0;
    double second_log = 0.0;
    double robot_log = 0.0;
  };

  /// `agree`: the stations agree now; only what has happened since they last did counts.
  void add(std::int64_t stamp_ns, const Sample& sample, bool agree);
  void restart();

  /// 0 or 1; -1 where nobody can tell.
  [[nodiscard]] int wrong() const;

 private:
  /// Means over a second or two.
  struct Mean {
    double first_log = 0.0;
    double second_log = 0.0;
    double robot_log = 0.0;
    int count = 0;
    bool robot_known = true;
    void add(const Sample& sample);
    [[nodiscard]] Sample value() const;
  };
  static constexpr std::size_t kKept = 4;

  void close(std::int64_t stamp_ns, bool agree);

  Mean open_;
  std::array<Sample, kKept> agreed_{};  // the last means while the stations agreed, oldest first
  std::size_t agreed_count_ = 0;
  Sample newest_;
  std::int64_t opened_ns_ = 0;
  std::int64_t agreed_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  bool has_newest_ = false;
  bool broken_ = false;  // the robot's height was not known all the time from agreed_ to newest_
};

}  // namespace isobar
