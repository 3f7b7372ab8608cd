// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/outputs.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/dds/footprint.hpp"
#include "ipc/dds/samples.hpp"

namespace isobar::dds {
namespace {

bool equal(const PosePropagatorConfig& a, const PosePropagatorConfig& b) {
  return a.slew_time_s == b.slew_time_s && a.max_slew_m_s == b.max_slew_m_s &&
         a.max_slew_rad_s == b.max_slew_rad_s && a.max_extrapolation_s == b.max_extrapolation_s;
}

TfMessage message_over(TransformStampedMessage* transforms, std::size_t count) {
  TfMessage message{};
  message.transforms._buffer = transforms;
  message.transforms._length = message.transforms._maximum = static_cast<std::uint32_t>(count);
  return message;
}

}  // namespace

PoseOutputs::Writers::Writers(dds_entity_t participant, const DdsConfig& config)
    : odom(participant, topics::kOdom, config.ros_namespace, config.topics.odom),
      pose(participant, topics::kPose, config.ros_namespace, config.topics.pose),
      altitude(participant, topics::kAltitude, config.ros_namespace, config.topics.altitude) {
  if (config.publish_tf_map_odom || config.publish_tf_odom_base) {
    tf.emplace(participant, topics::kTf, "", config.topics.tf);
  }
  if (config.publish_tf_static)
    tf_static.emplace(participant, topics::kTfStatic, "", config.topics.tf_static);
}

PoseOutputs::PoseOutputs(const DdsConfig& config, const SensorMounts& mounts)
    : config_(config),
      first_map_frame_(config.map_frame),
      mounts_(mounts),
      propagator_(config.propagator),
      odom_rate_(config.odom_rate_hz),
      altitude_rate_(config.altitude_rate_hz) {}

void PoseOutputs::configure(const DdsConfig& config, const SensorMounts& mounts) {
  if (!equal(config.propagator, config_.propagator)) propagator_ = PosePropagator(config.propagator);
  config_ = config;
  first_map_frame_ = config.map_frame;
  config_.map_frame = frame_of_session(first_map_frame_, session_);
  mounts_ = mounts;
  odom_rate_ = RateLimit(config.odom_rate_hz);
  altitude_rate_ = RateLimit(config.altitude_rate_hz);
}

void PoseOutputs::open(dds_entity_t participant) {
  to_.emplace(participant, config_);
  if (to_->tf_static) write_static_transforms();
}

void PoseOutputs::close() noexcept { to_.reset(); }

void PoseOutputs::on_prior(const Prior& prior) {
  // Without a source the height is a zero that nobody measured.
  if (to_ && prior.height_source != HeightSource::kNone && altitude_rate_.due(prior.stamp_ns)) {
    AltitudeMessage message{};
    Prior published = prior;
    published.stamp_ns += shift_ns_;
    fill_altitude(published, last_pose_, config_, message);
    to_->altitude.write(message);
  }
  Odometry odometry;
  if (!propagator_.propagate(prior, odometry) || !odom_rate_.due(prior.stamp_ns) || !to_) {
    return;
  }
  odometry.stamp_ns += shift_ns_;
  OdometryMessage message{};
  fill_odometry(odometry, config_, message);
  to_->odom.write(message);
  if (to_->tf) write_transforms(odometry);
}

void PoseOutputs::on_pose(const PoseEstimate& pose) {
  if (pose.mode == PoseMode::kInitializing) return;
  follow_session(pose.session);
  propagator_.add_pose(pose);
  last_pose_ = pose;
  if (!to_) return;
  PoseEstimate published = pose;
  published.stamp_ns += shift_ns_;
  PoseMessage message{};
  fill_pose(published, config_, message);
  to_->pose.write(message);
}

// A new map frame has a name of its own: consumers see that poses before and after cannot be compared.
void PoseOutputs::follow_session(std::uint32_t session) {
  if (session == session_) return;
  session_ = session;
  config_.map_frame = frame_of_session(first_map_frame_, session);
}

void PoseOutputs::write_transforms(const Odometry& odometry) {
  std::array<TransformStampedMessage, 3> transforms{};
  std::size_t count = 0;
  if (config_.publish_tf_map_odom) {
    fill_transform(odometry.stamp_ns, config_.map_frame, config_.odom_frame, odometry.T_map_odom,
                   transforms[count++]);
  }
  const std::string& footprint = config_.footprint_frame;
  if (config_.publish_tf_odom_base && footprint.empty()) {
    fill_transform(odometry.stamp_ns, config_.odom_frame, config_.base_frame, odometry.T_odom_base,
                   transforms[count++]);
  } else if (config_.publish_tf_odom_base) {
    const Eigen::Isometry3d T_odom_footprint = footprint_of(odometry.T_odom_base, config_.footprint_depth_m);
    fill_transform(odometry.stamp_ns, config_.odom_frame, footprint, T_odom_footprint, transforms[count++]);
    fill_transform(odometry.stamp_ns, footprint, config_.base_frame,
                   T_odom_footprint.inverse(Eigen::Isometry) * odometry.T_odom_base, transforms[count++]);
  }
  to_->tf->write(message_over(transforms.data(), count));
}

void PoseOutputs::write_static_transforms() {
  std::array<TransformStampedMessage, 3> transforms{};
  const auto fill = [this](const std::string& child, const Mount& mount, TransformStampedMessage& message) {
    fill_transform(0, config_.base_frame, child, mount.T_base_sensor(), message);
  };
  fill(config_.lidar_frame, mounts_.lidar, transforms[0]);
  fill(config_.imu_frame, mounts_.imu, transforms[1]);
  fill(config_.barometer_frame, mounts_.barometer, transforms[2]);
  to_->tf_static->write(message_over(transforms.data(), transforms.size()));
}

std::vector<dds_entity_t> PoseOutputs::writers() const {
  if (!to_) return {};
  std::vector<dds_entity_t> writers{to_->odom.get(), to_->pose.get(), to_->altitude.get()};
  if (to_->tf) writers.push_back(to_->tf->get());
  if (to_->tf_static) writers.push_back(to_->tf_static->get());
  return writers;
}

std::uint64_t PoseOutputs::failures() const noexcept {
  if (!to_) return 0;
  return to_->odom.failures() + to_->pose.failures() + to_->altitude.failures() +
         (to_->tf ? to_->tf->failures() : 0) + (to_->tf_static ? to_->tf_static->failures() : 0);
}

StationOutputs::StationOutputs(const DdsConfig& config) : config_(config) {}

void StationOutputs::open(dds_entity_t participant) {
  const std::string& station = config_.base_station;
  to_.emplace(Writers{{participant, topics::kBasePressure, station, config_.topics.base_pressure},
                      {participant, topics::kBaseTemperature, station, config_.topics.base_temperature}});
}

void StationOutputs::on_pressure(const PressureSample& measured, std::int64_t shift_ns) {
  if (!to_) return;
  PressureSample sample = measured;
  sample.stamp_ns += shift_ns;
  // Temperature first: a robot matches it on receiving the pressure.
  if (!std::isnan(sample.temperature_c)) {
    TemperatureMessage message{};
    fill_temperature(sample, config_.base_station, message);
    to_->temperature.write(message);
  }
  PressureMessage message{};
  fill_pressure(sample, config_.base_station, message);
  to_->pressure.write(message);
}

std::vector<dds_entity_t> StationOutputs::writers() const {
  if (!to_) return {};
  return {to_->pressure.get(), to_->temperature.get()};
}

std::uint64_t StationOutputs::failures() const noexcept {
  return to_ ? to_->pressure.failures() + to_->temperature.failures() : 0;
}

CloudOutputs::CloudOutputs(const DdsConfig& config) : config_(config) {}

void CloudOutputs::open(dds_entity_t participant) {
  to_.emplace(
      Writers{{participant, topics::kRegisteredScan, config_.ros_namespace, config_.topics.registered_scan},
              {participant, topics::kMapCloud, config_.ros_namespace, config_.topics.map_cloud}});
  if (map_.complete()) write_map();
}

void CloudOutputs::on_scan(const RegisteredScan& scan, std::int64_t shift_ns) {
  if (!to_ || !to_->scan.has_readers()) return;
  const std::uint32_t count = std::min(scan.point_count, RegisteredScan::kMaxPoints);
  scan_builder_.clear();
  scan_builder_.append({scan.points, count});
  to_->scan.write(scan_builder_.message(scan.pose.stamp_ns + shift_ns, config_.base_frame));
}

void CloudOutputs::on_map(const ipc::MapCloud& piece, std::int64_t shift_ns) {
  map_shift_ns_ = shift_ns;
  map_session_ = piece.session;
  if (map_.add(piece, map_builder_) && to_) write_map();
}

void CloudOutputs::write_map() {
  to_->map.write(map_builder_.message(map_.stamp_ns() + map_shift_ns_,
                                      frame_of_session(config_.map_frame, map_session_)));
}

void CloudOutputs::forget_map() {
  map_ = {};
  map_builder_.release();
}

std::vector<dds_entity_t> CloudOutputs::writers() const {
  if (!to_) return {};
  return {to_->scan.get(), to_->map.get()};
}

std::uint64_t CloudOutputs::failures() const noexcept {
  return to_ ? to_->scan.failures() + to_->map.failures() : 0;
}

}  // namespace isobar::dds
