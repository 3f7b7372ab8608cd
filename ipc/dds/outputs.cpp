// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/outputs.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/dds/samples.hpp"

namespace isobar::dds {
namespace {

template <std::size_t N>
TfMessage message_over(std::array<TransformStampedMessage, N>& transforms) {
  TfMessage message{};
  message.transforms._buffer = transforms.data();
  message.transforms._length = message.transforms._maximum = N;
  return message;
}

}  // namespace

PoseOutputs::PoseOutputs(dds_entity_t participant, const DdsConfig& config, const SensorMounts& mounts)
    : config_(config),
      propagator_(config.propagator),
      odom_rate_(config.odom_rate_hz),
      altitude_rate_(config.altitude_rate_hz),
      odom_(participant, topics::kOdom, config.ros_namespace),
      pose_(participant, topics::kPose, config.ros_namespace),
      tf_(participant, topics::kTf),
      tf_static_(participant, topics::kTfStatic),
      altitude_(participant, topics::kAltitude, config.ros_namespace) {
  write_static_transforms(mounts);
}

void PoseOutputs::on_prior(const Prior& prior) {
  if (altitude_rate_.due(prior.stamp_ns)) {
    AltitudeMessage message{};
    Prior published = prior;
    published.stamp_ns += shift_ns_;
    fill_altitude(published, config_, message);
    altitude_.write(message);
  }
  Odometry odometry;
  if (!propagator_.propagate(prior, odometry) || !odom_rate_.due(prior.stamp_ns)) {
    return;
  }
  odometry.stamp_ns += shift_ns_;
  OdometryMessage message{};
  fill_odometry(odometry, config_, message);
  odom_.write(message);
  write_transforms(odometry);
}

void PoseOutputs::on_pose(const PoseEstimate& pose) {
  propagator_.add_pose(pose);
  PoseEstimate published = pose;
  published.stamp_ns += shift_ns_;
  PoseMessage message{};
  fill_pose(published, config_, message);
  pose_.write(message);
}

StationOutputs::StationOutputs(dds_entity_t participant, const std::string& name)
    : frame_(name),
      pressure_(participant, topics::kBasePressure, name),
      temperature_(participant, topics::kBaseTemperature, name) {}

void StationOutputs::on_pressure(const PressureSample& measured, std::int64_t shift_ns) {
  PressureSample sample = measured;
  sample.stamp_ns += shift_ns;
  // Temperature first: a robot matches it on receiving the pressure.
  if (!std::isnan(sample.temperature_c)) {
    TemperatureMessage message{};
    fill_temperature(sample, frame_, message);
    temperature_.write(message);
  }
  PressureMessage message{};
  fill_pressure(sample, frame_, message);
  pressure_.write(message);
}

void PoseOutputs::write_transforms(const Odometry& odometry) {
  std::array<TransformStampedMessage, 2> transforms{};
  fill_transform(odometry.stamp_ns, config_.map_frame, config_.odom_frame, odometry.T_map_odom,
                 transforms[0]);
  fill_transform(odometry.stamp_ns, config_.odom_frame, config_.base_frame, odometry.T_odom_base,
                 transforms[1]);
  tf_.write(message_over(transforms));
}

void PoseOutputs::write_static_transforms(const SensorMounts& mounts) {
  std::array<TransformStampedMessage, 3> transforms{};
  const auto fill = [this](const std::string& child, const Mount& mount, TransformStampedMessage& message) {
    fill_transform(0, config_.base_frame, child, mount.T_base_sensor(), message);
  };
  fill(config_.lidar_frame, mounts.lidar, transforms[0]);
  fill(config_.imu_frame, mounts.imu, transforms[1]);
  fill(config_.barometer_frame, mounts.barometer, transforms[2]);
  tf_static_.write(message_over(transforms));
}

std::vector<dds_entity_t> PoseOutputs::writers() const {
  return {odom_.get(), pose_.get(), tf_.get(), tf_static_.get(), altitude_.get()};
}

std::uint64_t PoseOutputs::failures() const noexcept {
  return odom_.failures() + pose_.failures() + tf_.failures() + tf_static_.failures() + altitude_.failures();
}

CloudOutputs::CloudOutputs(dds_entity_t participant, const DdsConfig& config)
    : config_(config),
      scan_(participant, topics::kRegisteredScan, config.ros_namespace),
      map_(participant, topics::kMap, config.ros_namespace) {}

void CloudOutputs::on_scan(const RegisteredScan& scan, std::int64_t shift_ns) {
  if (!scan_.has_readers()) {
    return;
  }
  const std::uint32_t count = std::min(scan.point_count, RegisteredScan::kMaxPoints);
  scan_.write(builder_.build(scan.pose.stamp_ns + shift_ns, config_.base_frame, scan.points, count, true));
}

void CloudOutputs::on_map(const ipc::MapCloud& map, std::int64_t shift_ns) {
  const std::uint32_t count = std::min(map.point_count, ipc::MapCloud::kMaxPoints);
  map_.write(builder_.build(map.stamp_ns + shift_ns, config_.map_frame, map.points, count, false));
}

}  // namespace isobar::dds
