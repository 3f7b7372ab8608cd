// SPDX-License-Identifier: BSD-3-Clause
#include "run/mcap/input_export.hpp"

#include "run/mcap/frames.hpp"
#include "run/mcap/lazy_channel.hpp"
#include "run/mcap/ros_messages.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar::mcap {

namespace {

FramePose pose_of(const Eigen::Isometry3d& mount, std::int64_t stamp_ns) {
  return {stamp_ns, mount.translation(), Eigen::Quaterniond(mount.linear()).normalized()};
}

void write_mounts(const recording::Manifest& manifest, std::int64_t stamp_ns, McapWriter& out) {
  LazyChannel mounts(out, "/tf_static", "tf2_msgs/msg/TFMessage");
  const auto write = [&](const auto& entry, const char* frame) {
    if (entry)
      mounts.write(stamp_ns,
                   transform_message(pose_of(entry->mount.T_base_sensor(), stamp_ns), kBaseFrame, frame));
  };
  write(manifest.lidar, kLidarFrame);
  write(manifest.imu, kImuFrame);
  write(manifest.barometer, kBarometerFrame);
}

}  // namespace

void export_inputs(const std::filesystem::path& recording, McapWriter& out,
                   const std::function<void(double)>& progress) {
  recording::RecordingReader reader(recording);
  LazyChannel imu(out, "/imu/data", "sensor_msgs/msg/Imu");
  LazyChannel pressure(out, "/fluid_pressure", "sensor_msgs/msg/FluidPressure");
  LazyChannel base_pressure(out, "/base/fluid_pressure", "sensor_msgs/msg/FluidPressure");
  LazyChannel wheels(out, "/wheel/twist", "geometry_msgs/msg/TwistStamped");
  recording::Event event;
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    if (events == 0) write_mounts(reader.manifest(), event.stamp_ns, out);
    switch (event.kind) {
      case recording::EventKind::kImu:
        imu.write(event.stamp_ns, imu_message(event.imu, kImuFrame));
        break;
      case recording::EventKind::kPressure:
        pressure.write(event.stamp_ns, pressure_message(event.pressure, kBarometerFrame));
        break;
      case recording::EventKind::kBasePressure:
        base_pressure.write(event.stamp_ns, pressure_message(event.pressure, kStationFrame));
        break;
      case recording::EventKind::kWheel:
        wheels.write(event.stamp_ns, twist_message(event.wheel, kBaseFrame));
        break;
      case recording::EventKind::kCloud:
      case recording::EventKind::kLidarPacket:
        break;
    }
    if (events % 4096 == 0) progress(reader.progress());
  }
}

}  // namespace isobar::mcap
