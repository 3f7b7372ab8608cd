// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/estimates.hpp"
#include "run/files/text_file.hpp"

namespace isobar::files {

/// Header line of status.csv. `method` is the method that ran (PoseEstimate::effective_method); `scan_ms` is
/// PoseEstimate::registration_ms; sd_* are the square roots of the covariance's diagonal.
inline constexpr std::string_view kStatusColumns =
    "t_ns,sequence,mode,method,height_source,degenerate,iterations,sampled_points,matched_pairs,overlap,"
    "residual_rms_m,eigenvalue_0,eigenvalue_1,eigenvalue_2,scan_ms,altimeter_height_m,altimeter_sd_m,"
    "x_m,y_m,z_m,sd_x_m,sd_y_m,sd_z_m,sd_yaw_rad";

/// Streams poses into trajectory.tum and status.csv of a folder, which it creates; files of an earlier run
/// are replaced. Not thread-safe.
/// @throws ServiceError naming the file when writing fails
class PoseWriter {
 public:
  explicit PoseWriter(const std::filesystem::path& directory);

  /// @param altimeter_height_m height above the start, NaN when unknown
  /// @param altimeter_sd_m its standard deviation, NaN when unknown
  void add(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m);
  void close();
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  OutputFile trajectory_;
  OutputFile status_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::files
