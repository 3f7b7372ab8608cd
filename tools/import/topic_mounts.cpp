// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/topic_mounts.hpp"

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "core/printable_text.hpp"

namespace isobar::tools {
namespace {

/// The robot's frame among those of the container; the lidar's where it has none.
std::string base_of(const TopicSurvey& survey, const ImportRequest& request, const std::string& lidar_frame) {
  for (const std::string& name :
       {request.base_frame, std::string("base_link"), std::string("base_footprint"), std::string("base")}) {
    if (survey.frames.holds(name) && (lidar_frame.empty() || survey.frames.find(name, lidar_frame)))
      return name;
  }
  return lidar_frame;
}

}  // namespace

Mount mount_of(const Eigen::Isometry3d& T_base_sensor) {
  const Eigen::Matrix3d R = T_base_sensor.linear();
  // Pitch of 90 degrees: roll and yaw turn about one axis.
  constexpr double kSteep = 1.0 - 1e-12;
  if (std::abs(R(2, 0)) > kSteep) {
    const Eigen::Vector3d steep_rad(0.0, R(2, 0) < 0.0 ? kPi / 2.0 : -kPi / 2.0,
                                    std::atan2(-R(0, 1), R(1, 1)));
    return {T_base_sensor.translation(), steep_rad / kRadPerDeg};
  }
  // Inverse of R = Rz(yaw) Ry(pitch) Rx(roll).
  const Eigen::Vector3d rpy_rad(std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
                                std::atan2(R(1, 0), R(0, 0)));
  return {T_base_sensor.translation(), rpy_rad / kRadPerDeg};
}

void place_sensors(const TopicSurvey& survey, const ImportRequest& request, ImportPlan& plan,
                   std::vector<std::string>& notes) {
  const auto given = request.mounts();
  const auto frame_of = [&](const std::optional<PlannedTopic>& planned) {
    return planned ? survey.topics[planned->index].frame_id : std::string();
  };
  const std::string lidar_frame = frame_of(plan.lidar);
  const std::string base = base_of(survey, request, lidar_frame);
  const auto find = [&](const std::string& sensor, const std::string& frame, Mount& mount) {
    if (const auto of_person = given.find(sensor); of_person != given.end()) {
      mount = of_person->second;
      return true;
    }
    if (frame.empty() || base.empty()) return false;
    const auto T = frame == base ? Eigen::Isometry3d::Identity() : survey.frames.find(base, frame);
    if (T) mount = mount_of(*T);
    return T.has_value();
  };
  if (plan.manifest.lidar &&
      (!find("lidar", lidar_frame, plan.manifest.lidar->mount) || base == lidar_frame) &&
      !given.contains("lidar")) {
    notes.emplace_back(
        "mounts: where the lidar sits on the robot is not known: poses are those of the lidar; --mount "
        "lidar=x,y,z,roll,pitch,yaw says it");
  }
  if (plan.manifest.imu && !find("imu", frame_of(plan.imu), plan.manifest.imu->mount) &&
      plan.manifest.lidar) {
    throw UsageError("--mount: how the IMU (" + printable(frame_of(plan.imu)) +
                     ") sits relative to the lidar (" + printable(lidar_frame) +
                     ") is not in the source; say --mount imu=x,y,z,roll,pitch,yaw in base_link (m, degrees; "
                     "imu=0,0,0,0,0,0 where its axes are the lidar's), or --imu none");
  }
  if (plan.manifest.barometer &&
      !find("barometer", frame_of(plan.pressure), plan.manifest.barometer->mount)) {
    notes.emplace_back(
        "mounts: where the barometer's port sits is not known: taken for base_link, which matters for "
        "heights when the robot tilts");
  }
}

}  // namespace isobar::tools
