// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/messages.hpp"

#include <bit>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>

#include "core/names.hpp"

namespace isobar::dds {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

// Type numbers of sensor_msgs/PointField
constexpr std::uint8_t kUint16 = 4;
constexpr std::uint8_t kFloat32 = 7;

static_assert(std::endian::native == std::endian::little,
              "points are sent as their bytes in memory, declared little endian");

/// A point on the wire. Without the ring only the 16 bytes before it are sent.
struct CloudPoint {
  float x_m;
  float y_m;
  float z_m;
  float intensity;
  std::uint16_t ring;
  std::uint16_t padding;  // the next point's floats stay aligned
};
static_assert(sizeof(CloudPoint) == 20 && offsetof(CloudPoint, ring) == 16);

void fill_vector(const Eigen::Vector3d& vector, geometry_msgs_msg_dds__Vector3_& message) noexcept {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

void fill_rotation(const Eigen::Isometry3d& T, geometry_msgs_msg_dds__Quaternion_& message) noexcept {
  Eigen::Quaterniond q(T.linear());
  q.normalize();
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
}

void fill_pose_of(const Eigen::Isometry3d& T, geometry_msgs_msg_dds__Pose_& message) noexcept {
  message.position.x = T.translation().x();
  message.position.y = T.translation().y();
  message.position.z = T.translation().z();
  fill_rotation(T, message.orientation);
}

/// Row-major, as ROS defines it; Matrix6d has the same order of variables.
void fill_covariance(const Matrix6d& covariance, double (&message)[36]) noexcept {  // NOLINT
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      message[row * 6 + column] = covariance(row, column);
    }
  }
}

}  // namespace

TimeMessage to_time(std::int64_t stamp_ns) noexcept {
  std::int64_t seconds = stamp_ns / kSecondNs;
  std::int64_t rest = stamp_ns % kSecondNs;
  if (rest < 0) {
    --seconds;
    rest += kSecondNs;
  }
  return {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(rest)};
}

std::int64_t to_stamp_ns(const TimeMessage& time) noexcept {
  return static_cast<std::int64_t>(time.sec) * kSecondNs + static_cast<std::int64_t>(time.nanosec);
}

void fill_header(std::int64_t stamp_ns, const std::string& frame, HeaderMessage& header) noexcept {
  header.stamp = to_time(stamp_ns);
  header.frame_id = text(frame);
}

void fill_odometry(const Odometry& odometry, const DdsConfig& names, OdometryMessage& message) noexcept {
  fill_header(odometry.stamp_ns, names.odom_frame, message.header);
  message.child_frame_id = text(names.base_frame);
  fill_pose_of(odometry.T_odom_base, message.pose.pose);
  fill_covariance(odometry.pose_covariance, message.pose.covariance);
  fill_vector(odometry.v_base_m_s, message.twist.twist.linear);
  fill_vector(odometry.w_base_rad_s, message.twist.twist.angular);
  fill_covariance(odometry.twist_covariance, message.twist.covariance);
}

void fill_pose(const PoseEstimate& pose, const DdsConfig& names, PoseMessage& message) noexcept {
  fill_header(pose.stamp_ns, names.map_frame, message.header);
  fill_pose_of(pose.T_map_base, message.pose.pose);
  fill_covariance(pose.covariance, message.pose.covariance);
}

void fill_altitude(const Prior& prior, const PoseEstimate& pose, const DdsConfig& names,
                   AltitudeMessage& message) noexcept {
  const AltimeterState& altimeter = pose.altimeter;
  const double known =
      pose.effective_method == Method::kAdaptive ? 1.0 : std::numeric_limits<double>::quiet_NaN();
  fill_header(prior.stamp_ns, names.map_frame, message.header);
  message.height = prior.height_m;
  message.variance = prior.height_variance_m2;
  message.source = text(kHeightSourceNames.name(prior.height_source).data());
  message.bias = known * altimeter.bias_m;
  message.bias_variance = known * altimeter.bias_sd_m * altimeter.bias_sd_m;
  message.innovation = known * altimeter.innovation_m;
  message.airflow = known * altimeter.airflow_s2_m;
  message.airflow_variance = known * altimeter.airflow_sd_s2_m * altimeter.airflow_sd_s2_m;
  message.faulty = altimeter.faulty;
  message.drifting = text(kDriftSuspectNames.name(altimeter.drifts).data());
}

void fill_transform(std::int64_t stamp_ns, const std::string& parent, const std::string& child,
                    const Eigen::Isometry3d& T_parent_child, TransformStampedMessage& message) noexcept {
  fill_header(stamp_ns, parent, message.header);
  message.child_frame_id = text(child);
  fill_vector(T_parent_child.translation(), message.transform.translation);
  fill_rotation(T_parent_child, message.transform.rotation);
}

CloudBuilder::CloudBuilder(Fields fields)
    : fields_{{{text("x"), offsetof(CloudPoint, x_m), kFloat32, 1},
               {text("y"), offsetof(CloudPoint, y_m), kFloat32, 1},
               {text("z"), offsetof(CloudPoint, z_m), kFloat32, 1},
               {text("intensity"), offsetof(CloudPoint, intensity), kFloat32, 1},
               {text("ring"), offsetof(CloudPoint, ring), kUint16, 1}}},
      with_ring_(fields == Fields::kWithRing) {
  const std::size_t field_count = with_ring_ ? fields_.size() : fields_.size() - 1;
  message_.fields._buffer = fields_.data();
  message_.fields._length = message_.fields._maximum = static_cast<std::uint32_t>(field_count);
  message_.height = 1;
  message_.point_step = with_ring_ ? sizeof(CloudPoint) : offsetof(CloudPoint, ring);
  message_.is_dense = true;
}

void CloudBuilder::append(std::span<const ScanPoint> points) {
  const std::size_t begin = data_.size();
  data_.resize(begin + points.size() * message_.point_step);
  std::uint8_t* to = data_.data() + begin;
  for (const ScanPoint& from : points) {
    const CloudPoint point{from.x_m, from.y_m, from.z_m, static_cast<float>(from.intensity), from.ring, 0};
    std::memcpy(to, &point, message_.point_step);
    to += message_.point_step;
  }
}

const CloudMessage& CloudBuilder::message(std::int64_t stamp_ns, const std::string& frame) noexcept {
  fill_header(stamp_ns, frame, message_.header);
  message_.width = static_cast<std::uint32_t>(size());
  message_.row_step = message_.width * message_.point_step;
  message_.data._length = message_.data._maximum = message_.row_step;
  message_.data._buffer = data_.data();
  return message_;
}

bool MapAssembly::add(const ipc::MapCloud& piece, CloudBuilder& cloud) {
  if (piece.first_point == 0) {
    cloud.clear();
    complete_ = false;
    sequence_ = piece.sequence;
    stamp_ns_ = piece.stamp_ns;
    begun_ = piece.total_points <= kMaxPoints;
  }
  begun_ = begun_ && piece.sequence == sequence_ && piece.first_point == cloud.size() &&
           piece.point_count <= ipc::MapCloud::kMaxPoints &&
           piece.point_count <= piece.total_points - piece.first_point;
  if (!begun_) return false;
  cloud.append({piece.points, piece.point_count});
  complete_ = cloud.size() == piece.total_points;
  begun_ = !complete_;
  return complete_;
}

DiagnosticsBuilder::DiagnosticsBuilder(const std::string& node) : node_(node) {
  for (std::size_t i = 0; i < kMaxStatuses; ++i) {
    values_[i] = {text("value"), texts_[i].value.data()};
    statuses_[i].name = texts_[i].name.data();
    statuses_[i].message = texts_[i].message.data();
    statuses_[i].hardware_id = text("isobar");
    statuses_[i].values._buffer = &values_[i];
    statuses_[i].values._length = statuses_[i].values._maximum = 1;
  }
  message_.header.frame_id = text("");
  message_.status._buffer = statuses_.data();
  message_.status._maximum = kMaxStatuses;
}

void DiagnosticsBuilder::start(std::int64_t stamp_ns) noexcept {
  message_.header.stamp = to_time(stamp_ns);
  message_.status._length = 0;
  without_place_ = 0;
}

void DiagnosticsBuilder::add(const char* name, ipc::HealthLevel level, const char* message,
                             double value) noexcept {
  if (message_.status._length < kMaxStatuses - 1) {
    write(message_.status._length++, name, level, message, value);
    return;
  }
  ++without_place_;
  message_.status._length = kMaxStatuses;
  write(kMaxStatuses - 1, "bridge/diagnostics_dropped", ipc::HealthLevel::kWarning,
        "entries left out: this message is full", static_cast<double>(without_place_));
}

void DiagnosticsBuilder::write(std::size_t index, const char* name, ipc::HealthLevel level,
                               const char* message, double value) noexcept {
  Texts& texts = texts_[index];
  std::snprintf(texts.name.data(), texts.name.size(), "%s: %s", node_.c_str(), name);
  std::snprintf(texts.message.data(), texts.message.size(), "%s", message);
  std::snprintf(texts.value.data(), texts.value.size(), "%.9g", value);
  statuses_[index].level = static_cast<std::uint8_t>(level);
}

}  // namespace isobar::dds
