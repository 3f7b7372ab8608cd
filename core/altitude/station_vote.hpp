// SPDX-License-Identifier: BSD-3-Clause
// Vote on the wrong one of two diverging base stations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Majority vote of three barometers, of which at most one is wrong: two base stations and the robot's own,
/// reduced to a common height by wheels and attitude. Without the robot's vote (no wheels, an elevator), a
/// station that changes faster than any weather is wrong.
class StationVote {
 public:
  /// ln of the three pressures [Pa]; the robot's is NaN where its height is unknown.
  struct Sample {
    double first_log = 0.0;
    double second_log = 0.0;
    double robot_log = 0.0;
  };

  /// `agree`: the stations agree at present; changes are counted from the last agreement on.
  void add(std::int64_t stamp_ns, const Sample& sample, bool agree);
  void restart();

  /// Index of the wrong station, 0 or 1; -1: undecided.
  [[nodiscard]] int wrong() const;

 private:
  /// Mean of the samples within the averaging time.
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
  std::array<Sample, kKept> agreed_{};  // last means in agreement, oldest first
  std::size_t agreed_count_ = 0;
  Sample newest_;
  std::int64_t opened_ns_ = 0;
  std::int64_t agreed_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  bool has_newest_ = false;
  bool broken_ = false;  // the robot's height was unknown at some time from agreed_ to newest_
};

}  // namespace isobar
