// SPDX-License-Identifier: BSD-3-Clause
// Two logs of a recorded rig, and the levels it stood on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/sensitivity_study.hpp"

namespace isobar::tools {

struct RecordedRigRequest {
  /// Folder with barometer.csv (moved), base_barometer.csv (standing) and optionally segments.csv; or the
  /// moved barometer's file.
  std::filesystem::path recording;
  std::filesystem::path base;      ///< the standing barometer's file; default: the folder's
  std::filesystem::path segments;  ///< levels, a label may be the height [m]; default: the folder's
  std::string columns;             ///< see parse_columns()
  std::string sensor = "recorded";
  std::optional<double> step_m;  ///< true height of a step
  std::size_t steps = 0;         ///< required number of steps; 0: any
  std::optional<double> lag_s;
  std::optional<double> settle_s;
  std::optional<double> air_c;  ///< default: the colder sensor's
};

struct RecordedRig {
  BarometerPair pair;
  std::filesystem::path moved_file;
  std::filesystem::path standing_file;
  StudyOptions options;
  std::vector<Plateau> plateaus;
  std::vector<std::string> notes;  ///< columns, clocks and steps, as sentences
};

/// @throws UsageError when no standing barometer is named
/// @throws DataError when a file is missing or has too few samples, or when the steps cannot be found in the
/// noise
RecordedRig read_recorded_rig(const RecordedRigRequest& request);

}  // namespace isobar::tools
