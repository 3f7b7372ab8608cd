// SPDX-License-Identifier: BSD-3-Clause
// Reader of the folder that a run leaves behind (run/files/run_layout.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "run/evaluation/consistency.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/files/ply_reader.hpp"

namespace isobar::evaluation {

/// The columns of status.csv that the evaluation uses; NaN where the file has no value.
struct StatusRow {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t stamp_ns = 0;
  std::string mode;
  double scan_ms = kUnknown;
  double altimeter_height_m = kUnknown;
  double sd_z_m = kUnknown;
  double altimeter_bias_m = kUnknown;
  double altimeter_bias_sd_m = kUnknown;
  double altimeter_innovation_m = kUnknown;
  double airflow_s2_m = kUnknown;
  double airflow_sd_s2_m = kUnknown;
  bool altimeter_faulty = false;
  std::string altimeter_drifts;  ///< kDriftSuspectNames; empty: unknown
};

/// A run's output. Only the trajectory is required.
struct RunFolder {
  Trajectory trajectory;
  std::vector<StatusRow> status;            ///< empty without status.csv
  std::vector<PoseCovariance> covariances;  ///< empty without covariance.csv: a run of an older version
  files::PlyPoints map;                     ///< map frame [m]; empty without map.ply
  std::string mounts;                       ///< mounts.toml; empty without it
  std::vector<std::string> notes;           ///< what was left out, in sentences
};

/// Reads the folder of a run. A map.ply that cannot be read is left out: a run that was killed leaves one.
/// @param max_map_points of a larger map every n-th point is kept
/// @throws DataError "file:line: rule" when a file breaks its format, or when there is no trajectory.tum
RunFolder read_run_folder(const std::filesystem::path& directory, std::size_t max_map_points);

/// Parses status.csv. Columns in any order, unknown ones ignored, only t_ns required; empty cells and "nan"
/// mean unknown. A last line that is cut is left out.
/// @throws DataError "name:line: rule" when a line breaks the format
std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name);

/// Parses covariance.csv: files::kCovarianceColumns in any order, all required, unknown ones ignored. A last line
/// that is cut is left out.
/// @throws DataError "name:line: rule" when a line breaks the format
std::vector<PoseCovariance> parse_covariance_csv(std::string_view text, const std::string& name);

}  // namespace isobar::evaluation
