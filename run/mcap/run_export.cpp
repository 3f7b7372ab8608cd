// SPDX-License-Identifier: BSD-3-Clause
#include "run/mcap/run_export.hpp"

#include <cmath>
#include <limits>
#include <unordered_map>

#include "run/evaluation/run_folder.hpp"
#include "run/files/run_layout.hpp"
#include "run/mcap/frames.hpp"
#include "run/mcap/input_export.hpp"
#include "run/mcap/mcap_writer.hpp"
#include "run/mcap/ros_messages.hpp"

namespace isobar::mcap {

namespace {

namespace fs = std::filesystem;

// Points of the map that are exported: more than a viewer draws at once.
constexpr std::size_t kMaxMapPoints = 4'000'000;

std::vector<FramePose> poses_of(const evaluation::Trajectory& trajectory) {
  std::vector<FramePose> poses;
  poses.reserve(trajectory.poses.size());
  for (const evaluation::StampedPose& pose : trajectory.poses)
    poses.push_back({pose.stamp_ns, pose.position_m, pose.attitude});
  return poses;
}

void write_poses(const std::vector<FramePose>& poses,
                 const std::vector<evaluation::PoseCovariance>& covariances, McapWriter& out) {
  std::unordered_map<std::int64_t, const evaluation::PoseCovariance*> by_stamp;
  for (const evaluation::PoseCovariance& one : covariances) by_stamp[one.stamp_ns] = &one;
  const std::uint16_t pose_channel = out.add_channel("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped");
  const std::uint16_t tf_channel = out.add_channel("/tf", "tf2_msgs/msg/TFMessage");
  for (const FramePose& pose : poses) {
    const auto known = by_stamp.find(pose.stamp_ns);
    const Matrix6 covariance = known == by_stamp.end() ? Matrix6::Zero() : Matrix6(known->second->covariance);
    out.write(pose_channel, pose.stamp_ns, pose_message(pose, kMapFrame, covariance));
    out.write(tf_channel, pose.stamp_ns, transform_message(pose, kMapFrame, kBaseFrame));
  }
}

void write_path(const std::string& topic, const std::vector<FramePose>& poses, McapWriter& out) {
  if (poses.empty()) return;
  out.write(out.add_channel(topic, "nav_msgs/msg/Path"), poses.front().stamp_ns,
            path_message(poses, kMapFrame));
}

Altitude altitude_of(const evaluation::StatusRow& row) {
  const auto squared = [](double sd) { return sd * sd; };
  Altitude altitude;
  altitude.stamp_ns = row.stamp_ns;
  altitude.height_m = row.altimeter_height_m;
  altitude.variance_m2 = evaluation::StatusRow::kUnknown;
  altitude.bias_m = row.altimeter_bias_m;
  altitude.bias_variance_m2 = squared(row.altimeter_bias_sd_m);
  altitude.innovation_m = row.altimeter_innovation_m;
  altitude.airflow_s2_m = row.airflow_s2_m;
  altitude.airflow_variance_s4_m2 = squared(row.airflow_sd_s2_m);
  altitude.faulty = row.altimeter_faulty;
  altitude.drifting = row.altimeter_drifts;
  return altitude;
}

void write_status(const std::vector<evaluation::StatusRow>& rows, McapWriter& out) {
  if (rows.empty()) return;
  const std::uint16_t altitude_channel = out.add_channel("/altitude", "isobar_msgs/msg/Altitude");
  const std::uint16_t time_channel = out.add_channel("/scan_time", "std_msgs/msg/Float64");
  for (const evaluation::StatusRow& row : rows) {
    if (std::isfinite(row.altimeter_height_m))
      out.write(altitude_channel, row.stamp_ns, altitude_message(altitude_of(row), kMapFrame));
    if (std::isfinite(row.scan_ms)) out.write(time_channel, row.stamp_ns, number_message(row.scan_ms));
  }
}

}  // namespace

ExportedRun export_run(const RunExport& wanted, const std::function<void(double)>& progress) {
  const evaluation::RunFolder run = evaluation::read_run_folder(wanted.run, kMaxMapPoints);
  progress(0.2);
  ExportedRun done;
  done.notes = run.notes;
  McapWriter out(wanted.out, wanted.library);
  const std::vector<FramePose> poses = poses_of(run.trajectory);
  // First what a viewer is to see at any time: map and whole paths stand at the first stamp.
  write_path("/path", poses, out);
  if (const fs::path corrected = wanted.run / files::kCorrectedTrajectoryFile; fs::exists(corrected))
    write_path("/path_corrected",
               poses_of(evaluation::parse_tum(files::read_text_file(corrected), corrected.string())), out);
  if (!run.map.points.empty()) {
    const std::int64_t stamp_ns = poses.front().stamp_ns;
    out.write(out.add_channel("/map_cloud", "sensor_msgs/msg/PointCloud2"), stamp_ns,
              cloud_message(stamp_ns, kMapFrame, run.map.points));
    if (run.map.total > run.map.points.size())
      done.notes.push_back("of " + std::to_string(run.map.total) + " points of the map " +
                           std::to_string(run.map.points.size()) + " were exported");
  }
  write_poses(poses, run.covariances, out);
  write_status(run.status, out);
  progress(0.5);
  if (!wanted.recording.empty())
    export_inputs(wanted.recording, out, [&](double fraction) { progress(0.5 + 0.5 * fraction); });
  out.close();
  done.messages = out.messages();
  done.bytes = out.bytes();
  progress(1.0);
  return done;
}

}  // namespace isobar::mcap
