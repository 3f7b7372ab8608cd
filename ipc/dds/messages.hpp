// SPDX-License-Identifier: BSD-3-Clause
// Conversion of Isobar's values to ROS 2 messages. Texts in the messages point into the arguments, which must
// outlive them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/estimates.hpp"
#include "core/registration/pose_propagator.hpp"
#include "ipc/dds/topics.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

using TimeMessage = builtin_interfaces_msg_dds__Time_;
using HeaderMessage = std_msgs_msg_dds__Header_;
using TransformStampedMessage = geometry_msgs_msg_dds__TransformStamped_;
using PointFieldMessage = sensor_msgs_msg_dds__PointField_;

/// A text as the generated C types declare it, char*. Nothing writes through the pointer.
[[nodiscard]] inline char* text(const char* value) noexcept { return const_cast<char*>(value); }
[[nodiscard]] inline char* text(const std::string& value) noexcept { return text(value.c_str()); }

/// ROS time of a stamp since the epoch, possibly negative: seconds are rounded down, nanoseconds are 0 …
/// 999999999.
[[nodiscard]] TimeMessage to_time(std::int64_t stamp_ns) noexcept;
[[nodiscard]] std::int64_t to_stamp_ns(const TimeMessage& time) noexcept;

/// Name of a map frame: that of the configuration for the first one, with _2, _3 … for later ones.
[[nodiscard]] inline std::string frame_of_session(const std::string& map_frame, std::uint32_t session) {
  return session <= 1 ? map_frame : map_frame + "_" + std::to_string(session);
}

void fill_header(std::int64_t stamp_ns, const std::string& frame, HeaderMessage& header) noexcept;
void fill_odometry(const Odometry& odometry, const DdsConfig& names, OdometryMessage& message) noexcept;
void fill_pose(const PoseEstimate& pose, const DdsConfig& names, PoseMessage& message) noexcept;
/// `pose`: the last one, for what it knows of the altimeter.
void fill_altitude(const Prior& prior, const PoseEstimate& pose, const DdsConfig& names,
                   AltitudeMessage& message) noexcept;
void fill_transform(std::int64_t stamp_ns, const std::string& parent, const std::string& child,
                    const Eigen::Isometry3d& T_parent_child, TransformStampedMessage& message) noexcept;

/// Builds PointCloud2 messages with the field types that PCL and RViz read: x, y, z (float32, metres),
/// intensity (float32, 0 … 255) and, for scans, ring (uint16).
class CloudBuilder {
 public:
  enum class Fields : std::uint8_t { kWithRing, kWithoutRing };

  explicit CloudBuilder(Fields fields);
  CloudBuilder(const CloudBuilder&) = delete;
  CloudBuilder& operator=(const CloudBuilder&) = delete;

  /// Removes all points. Their memory is kept for the next ones.
  void clear() noexcept { data_.clear(); }
  /// Removes all points and frees their memory.
  void release() noexcept { data_ = {}; }
  void append(std::span<const ScanPoint> points);
  [[nodiscard]] std::size_t size() const noexcept { return data_.size() / message_.point_step; }
  /// The message is valid until the next call of any function, and during the lifetime of `frame`.
  [[nodiscard]] const CloudMessage& message(std::int64_t stamp_ns, const std::string& frame) noexcept;

 private:
  std::array<PointFieldMessage, 5> fields_{};
  CloudMessage message_{};
  bool with_ring_;
  std::vector<std::uint8_t> data_;
};

/// Puts the map together from its pieces, which come one by one.
class MapAssembly {
 public:
  /// Most points of a map: 1 GiB of memory of the bridge.
  static constexpr std::uint32_t kMaxPoints = 1U << 26U;

  /// Appends a piece to the points of `cloud`. A first piece begins a new map; a piece without those before it
  /// is ignored, and the map with it.
  /// @return true when the map has become complete
  bool add(const ipc::MapCloud& piece, CloudBuilder& cloud);
  /// Whether the points are those of a whole map.
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  [[nodiscard]] std::int64_t stamp_ns() const noexcept { return stamp_ns_; }

 private:
  std::uint32_t sequence_ = 0;
  std::int64_t stamp_ns_ = 0;
  bool begun_ = false;
  bool complete_ = false;
};

/// Builds the diagnostics message from the health entries of isobard and of the bridge.
class DiagnosticsBuilder {
 public:
  /// @param node prefix of each status name, "node: name", by which ROS 2 tools group the statuses
  explicit DiagnosticsBuilder(const std::string& node = "isobar");
  DiagnosticsBuilder(const DiagnosticsBuilder&) = delete;
  DiagnosticsBuilder& operator=(const DiagnosticsBuilder&) = delete;

  void start(std::int64_t stamp_ns) noexcept;
  /// Adds a health entry, with copies of its texts. In a full message the last status counts the entries that
  /// found no place.
  void add(const char* name, ipc::HealthLevel level, const char* message, double value) noexcept;
  [[nodiscard]] const DiagnosticsMessage& message() const noexcept { return message_; }

  static constexpr std::size_t kMaxStatuses = ipc::HealthReport::kMaxEntries + 32;

 private:
  void write(std::size_t index, const char* name, ipc::HealthLevel level, const char* message,
             double value) noexcept;

  struct Texts {
    std::array<char, ipc::HealthEntry::kNameBytes + 110> name{};
    std::array<char, ipc::HealthEntry::kMessageBytes> message{};
    std::array<char, 32> value{};
  };
  std::string node_;
  std::size_t without_place_ = 0;
  std::array<Texts, kMaxStatuses> texts_{};
  std::array<diagnostic_msgs_msg_dds__KeyValue_, kMaxStatuses> values_{};
  std::array<diagnostic_msgs_msg_dds__DiagnosticStatus_, kMaxStatuses> statuses_{};
  DiagnosticsMessage message_{};
};

}  // namespace isobar::dds
