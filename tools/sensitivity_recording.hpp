// SPDX-License-Identifier: BSD-3-Clause
// A real rig's two logs, and the levels it stood on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/sensitivity_study.hpp"

namespace isobar::tools {

struct RecordedRigRequest {
  /// Folder with barometer.csv (moved), base_barometer.csv (standing) and perhaps segments.csv; or the moved
  /// barometer's file.
  std::filesystem::path recording;
  std::filesystem::path base;      ///< the standing one's file, if not the folder's
  std::filesystem::path segments;  ///< names the levels, if not the folder's; a label may be the height in m
  std::string columns;             ///< see parse_columns()
  std::string sensor = "recorded";
  std::optional<double> step_m;  ///< true height of a step
  std::size_t steps = 0;         ///< how many steps must be found; 0: as many as are seen
  std::optional<double> lag_s;
  std::optional<double> settle_s;
  std::optional<double> air_c;  ///< else the colder thermometer's
};

struct RecordedRig {
  BarometerPair pair;
  std::filesystem::path moved_file;
  std::filesystem::path standing_file;
  StudyOptions options;
  std::vector<Plateau> plateaus;
  std::vector<std::string> notes;  ///< how it was read, for a person
};

/// Throws UsageError where the standing barometer is missing, DataError where files are, where they hold
/// nothing, and where steps can not be found in the noise or not as many as there are.
RecordedRig read_recorded_rig(const RecordedRigRequest& request);

}  // namespace isobar::tools
