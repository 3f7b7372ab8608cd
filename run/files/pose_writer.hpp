// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/estimates.hpp"
#include "run/files/line_file.hpp"

namespace isobar::files {

/// Header line of status.csv. `method` is the method that ran (PoseEstimate::effective_method); `scan_ms` is
/// PoseEstimate::registration_ms; sd_* are the square roots of the covariance's diagonal; altimeter_bias_m … and
/// airflow_* are those of AltimeterState, nan in methods without it; weakest_* is the first direction of
/// PoseEstimate::localisability. New columns come last: a file that an older version began keeps its
/// columns when its run goes on.
inline constexpr std::string_view kStatusColumns =
    "t_ns,sequence,mode,method,height_source,degenerate,iterations,sampled_points,matched_pairs,overlap,"
    "residual_rms_m,eigenvalue_0,eigenvalue_1,eigenvalue_2,scan_ms,altimeter_height_m,altimeter_sd_m,"
    "x_m,y_m,z_m,sd_x_m,sd_y_m,sd_z_m,sd_yaw_rad,"
    "altimeter_bias_m,altimeter_bias_sd_m,altimeter_innovation_m,altimeter_faulty,altimeter_drifts,"
    "weak_directions,weakest_strength,weakest_x,weakest_y,weakest_z,weakest_roll,weakest_pitch,weakest_yaw,"
    "weakest_held_by,airflow_s2_m,airflow_sd_s2_m";

/// Header line of covariance.csv: the upper triangle of PoseEstimate::covariance, in m, rad and their products.
/// A file of its own, so that a run begun by an older version, whose status.csv has other columns, goes on.
inline constexpr std::string_view kCovarianceColumns =
    "t_ns,x_x,x_y,x_z,x_roll,x_pitch,x_yaw,y_y,y_z,y_roll,y_pitch,y_yaw,z_z,z_roll,z_pitch,z_yaw,"
    "roll_roll,roll_pitch,roll_yaw,pitch_pitch,pitch_yaw,yaw_yaw";

/// Writes poses into trajectory.tum, status.csv and covariance.csv of a folder, which it creates, as whole lines. Those of a
/// later map frame have the names of name_of_session(). Not thread-safe.
class PoseWriter {
 public:
  /// @throws ServiceError naming the file when it cannot be opened
  explicit PoseWriter(const std::filesystem::path& directory, Start start = Start::kNew,
                      std::uint32_t session = 1);

  /// @param altimeter_height_m height above the start, NaN when unknown
  /// @param altimeter_sd_m its standard deviation, NaN when unknown
  void add(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m);
  /// Writes the lines to the files; see LineFile.
  /// @throws ServiceError naming the file when writing fails
  void flush();
  /// Waits until the lines are on the disk.
  /// @throws ServiceError naming the file
  void sync();
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::size_t pending_bytes() const {
    return trajectory_.pending_bytes() + status_.pending_bytes() + covariance_.pending_bytes();
  }
  [[nodiscard]] std::uint64_t dropped_lines() const { return trajectory_.dropped_lines(); }
  /// Bytes of incomplete last lines that were removed at the start.
  [[nodiscard]] std::uint64_t removed_bytes() const {
    return trajectory_.removed_bytes() + status_.removed_bytes() + covariance_.removed_bytes();
  }

 private:
  LineFile trajectory_;
  std::string status_header_;
  LineFile status_;
  LineFile covariance_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::files
