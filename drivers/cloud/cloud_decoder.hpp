// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "drivers/cloud/cloud_view.hpp"
#include "drivers/lidar/lidar_decoder.hpp"

namespace isobar {

/// What the messages were found to hold.
struct CloudFormat {
  std::string ring;  ///< name of the field; empty: none
  std::string time;  ///< name of the field; empty: none that tells times
  double time_unit_s = 0.0;
  bool is_absolute = false;  ///< times are those of the header's clock, not relative to its stamp
  std::string intensity;

  friend bool operator==(const CloudFormat&, const CloudFormat&) = default;
};

/// Counters since construction; one writer.
struct CloudCounters {
  std::uint64_t clouds = 0;
  std::uint64_t refused = 0;    ///< messages that break a rule
  std::uint64_t points = 0;     ///< written
  std::uint64_t no_return = 0;  ///< not finite, or nearer than the shortest range: lidars say "no return" so
  std::uint64_t thinned = 0;    ///< left out of clouds of more than Scan::kMaxPoints points
};

/// Converts the clouds of any lidar driver to scans.
///
/// Drivers do not agree on the fields of a cloud beside x, y, z. The laser is `ring`, `line`, `channel` or
/// `laser_id`; the time of a point is `time`, `t`, `timestamp`, `time_stamp`, `offset_time` …, in seconds,
/// milliseconds, microseconds or nanoseconds, absolute or relative to the header's stamp, before or after it. The
/// unit is told by the values: a scan lasts 5 to 260 ms, and no two units are that near. Without times all points
/// count as measured at the header's stamp: nothing is deskewed. Without rings the elevation tells the laser.
class CloudDecoder {
 public:
  explicit CloudDecoder(const LidarLimits& limits = {}) : limits_(limits) {}

  /// @param scan filled, its stamps on the clock of the header, points in the order of time
  /// @return nullptr, or the rule that the message breaks; the scan is then without points
  [[nodiscard]] const char* decode(const CloudView& cloud, Scan& scan);

  void set_limits(const LidarLimits& limits) { limits_ = limits; }
  [[nodiscard]] const CloudFormat& format() const { return format_; }
  /// The format in a sentence, with what is missing and what that costs.
  [[nodiscard]] std::string sentence() const;
  [[nodiscard]] const CloudCounters& counters() const { return counters_; }

 private:
  struct Fields {
    CloudField x, y, z;
    std::optional<CloudField> ring, time, intensity;
  };
  /// Times of a cloud: of its first point, and the values that stand for it.
  struct Times {
    bool known = false;
    double first = 0.0;  // smallest value
    double unit_s = 0.0;
    std::int64_t first_ns = 0;  // on the clock of the header
  };

  [[nodiscard]] const char* check(const CloudView& cloud, Fields& fields) const;
  [[nodiscard]] Times times_of(const CloudView& cloud, const CloudField& field) const;
  void add_points(const CloudView& cloud, const Fields& fields, const Times& times, Scan& scan);
  [[nodiscard]] bool is_kept(float x, float y, float z);

  LidarLimits limits_;
  CloudFormat format_;
  CloudCounters counters_;
};

}  // namespace isobar
