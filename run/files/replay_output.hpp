// SPDX-License-Identifier: BSD-3-Clause
// The folder that a run of the estimator leaves behind, and that the evaluation reads:
//   trajectory.tum  pose of base_link per scan
//   status.csv      how each pose came about (columns: kStatusColumns)
//   map.ply         the map, binary little endian, x y z intensity as floats
//   settings.toml   every setting the run used
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/estimates.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/files/text_file.hpp"

namespace isobar::files {

/// Header line of status.csv. `method` is the method that ran (PoseEstimate::effective_method); `scan_ms` is
/// PoseEstimate::registration_ms; sd_* are the square roots of the covariance's diagonal.
inline constexpr std::string_view kStatusColumns =
    "t_ns,sequence,mode,method,height_source,degenerate,iterations,sampled_points,matched_pairs,overlap,"
    "residual_rms_m,eigenvalue_0,eigenvalue_1,eigenvalue_2,scan_ms,altimeter_height_m,altimeter_sd_m,"
    "x_m,y_m,z_m,sd_x_m,sd_y_m,sd_z_m,sd_yaw_rad";

/// Streams points into a binary PLY file; the number of points is patched into the header at close().
/// Throws ServiceError naming the file if writing fails. Not thread-safe.
class PlyWriter {
 public:
  explicit PlyWriter(const std::filesystem::path& file);
  /// Without close() the file keeps the count 0: an interrupted run is seen as such.
  ~PlyWriter() = default;
  PlyWriter(const PlyWriter&) = delete;
  PlyWriter& operator=(const PlyWriter&) = delete;

  /// x, y, z [m] in the map frame; intensity 0 … 255.
  void add(float x_m, float y_m, float z_m, float intensity);
  void close();
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  OutputFile file_;
  std::uint64_t count_ = 0;
};

/// Writes trajectory.tum and status.csv while a run goes on. Creates the folder; replaces files of an earlier
/// run. Throws ServiceError naming the file if writing fails. Not thread-safe.
class ReplayOutputWriter {
 public:
  explicit ReplayOutputWriter(const std::filesystem::path& directory);

  /// One pose. The altimeter's height above its start and standard deviation [m] may be NaN: unknown.
  void add(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m);
  /// settings.toml, whole.
  void write_settings(std::string_view toml) const;
  /// Where map.ply belongs, for a PlyWriter.
  [[nodiscard]] std::filesystem::path map_file() const { return directory_ / "map.ply"; }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  void close();

 private:
  std::filesystem::path directory_;
  OutputFile trajectory_;
  OutputFile status_;
  std::uint64_t count_ = 0;
};

/// One row of status.csv, as far as the evaluation uses it; NaN where the file does not say.
struct StatusRow {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t stamp_ns = 0;
  std::string mode;
  std::string method;
  double scan_ms = kUnknown;
  double altimeter_height_m = kUnknown;
  double altimeter_sd_m = kUnknown;
  double sd_z_m = kUnknown;
};

/// What a run left behind. Only the trajectory is required.
struct ReplayOutput {
  std::filesystem::path directory;
  evaluation::Trajectory trajectory;
  std::vector<StatusRow> status;                 ///< empty if there is no status.csv
  std::vector<std::array<float, 3>> map_points;  ///< map frame [m]; empty if there is no map.ply
  std::uint64_t map_points_total = 0;            ///< points in map.ply; map_points may be thinned
};

/// Reads a folder written by ReplayOutputWriter. Of a larger map every n-th point is kept, so that at most
/// `max_map_points` come back. Throws DataError "file:line: rule".
ReplayOutput read_replay_output(const std::filesystem::path& directory,
                                std::size_t max_map_points = 4'000'000);

/// Parses status.csv. The columns may stand in any order, unknown ones are ignored, only t_ns is required;
/// empty cells and "nan" mean unknown. Throws DataError "name:line: rule".
std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name);

/// Reads x, y, z of a binary little-endian PLY file whose vertices hold float or double x, y, z and any other
/// scalar properties; every n-th point, so that at most `max_points` come back. Points that are not finite
/// are left out. Returns the points and, through `total`, how many the file holds. Throws DataError.
std::vector<std::array<float, 3>> read_ply_points(const std::filesystem::path& file, std::size_t max_points,
                                                  std::uint64_t& total);

}  // namespace isobar::files
