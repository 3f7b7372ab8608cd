// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "run/recording/manifest.hpp"
#include "tools/import/request.hpp"
#include "tools/import/topic_survey.hpp"

namespace isobar::tools {

/// A topic that becomes a file of the recording.
struct PlannedTopic {
  std::size_t index = 0;       ///< in the survey, and of the stream's channels
  std::int64_t shift_ns = 0;   ///< added to the stamps of its headers
  bool uses_log_time = false;  ///< its headers tell no time
};

/// What becomes of the topics of a container.
struct ImportPlan {
  recording::Manifest manifest;
  std::optional<PlannedTopic> lidar;
  std::optional<PlannedTopic> lidar_info;  ///< an Ouster's other packets
  std::optional<PlannedTopic> imu;
  std::optional<PlannedTopic> pressure;
  std::optional<PlannedTopic> temperature;  ///< of the pressure's sensor
  std::optional<PlannedTopic> base_pressure;
  std::optional<PlannedTopic> wheel;
  std::optional<PlannedTopic> reference;
  double accel_scale = 1.0;
  double gyro_scale = 1.0;
  double pressure_scale = 1.0;
  double base_pressure_scale = 1.0;
  bool keeps_attitude = true;  ///< the IMU's own attitude turns
  std::string lidar_metadata;  ///< text of the calibration file; empty: none
  Eigen::Isometry3d T_child_base = Eigen::Isometry3d::Identity();  ///< of the reference's frame
};

/// Chooses topics, units, clocks and mounts, and fills the report's rows and notes.
/// @throws UsageError with the option that a person must give, where several things are possible
[[nodiscard]] ImportPlan plan_import(const TopicSurvey& survey, const ImportRequest& request,
                                     ImportReport& report);

}  // namespace isobar::tools
