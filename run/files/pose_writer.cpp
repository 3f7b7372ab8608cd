// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/pose_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "run/files/run_layout.hpp"
#include "run/text/tum_row.hpp"

namespace isobar::files {

namespace {

std::filesystem::path made_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw ServiceError(directory.string() + ": cannot be created: " + error.message());
  return directory;
}

using Line = std::array<char, 8192>;  // holds every column at 1e308

std::string_view text_of(const Line& line, int length) {
  return {line.data(), std::min(static_cast<std::size_t>(length), line.size() - 1)};
}

std::string trajectory_line(const PoseEstimate& pose) {
  std::string line;
  text::append_tum_row({pose.stamp_ns, pose.T_map_base.translation(),
                        Eigen::Quaterniond(pose.T_map_base.linear()).normalized()},
                       line);
  return line;
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Columns that status.csv has: all, or those of the older version that began the file.
std::string status_header(const std::filesystem::path& file, Start start) {
  if (start == Start::kNew) return std::string(kStatusColumns);
  const std::string known = first_line(file);
  const bool older = !known.empty() && kStatusColumns.starts_with(known) &&
                     kStatusColumns.substr(known.size()).starts_with(',');
  return older ? known : std::string(kStatusColumns);
}

/// The line without the columns that `header` does not have.
std::string_view with_columns_of(std::string_view header, std::string_view line) {
  if (header.size() == kStatusColumns.size()) return line;
  std::size_t end = 0;
  for (auto left = std::count(header.begin(), header.end(), ','); left >= 0; --left)
    end = line.find(',', end) + 1;
  return line.substr(0, end - 1);
}

std::string_view status_line(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m,
                             Line& line) {
  const auto sd = [&](int axis) { return std::sqrt(std::max(0.0, pose.covariance(axis, axis))); };
  const Eigen::Vector3d p = pose.T_map_base.translation();
  const Eigen::Vector3d& eigenvalues = pose.smallest_eigenvalues;
  const Direction& weakest = pose.localisability.directions[0];
  const auto part = [&](std::size_t axis) { return static_cast<double>(weakest.axis[axis]); };
  const bool any = pose.localisability.count > 0;
  const AltimeterState& altimeter = pose.altimeter;
  const double known = pose.effective_method == Method::kAdaptive ? 1.0 : NAN;
  const int length = std::snprintf(
      line.data(), line.size(),
      "%lld,%u,%s,%s,%s,%d,%u,%u,%u,%.4f,%.6f,%.6g,%.6g,%.6g,%.3f,%.4f,%.4f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%."
      "6g,%.4f,%.4f,%.4f,%d,%s,"
      "%zu,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%s,%.5f,%.5f\n",
      static_cast<long long>(pose.stamp_ns), pose.sequence, kPoseModeNames.name(pose.mode).data(),
      kMethodNames.name(pose.effective_method).data(), kHeightSourceNames.name(pose.height_source).data(),
      pose.degenerate ? 1 : 0, pose.iterations, pose.sampled_points, pose.matched_pairs, pose.overlap,
      pose.residual_rms_m, eigenvalues[0], eigenvalues[1], eigenvalues[2], pose.registration_ms,
      altimeter_height_m, altimeter_sd_m, p.x(), p.y(), p.z(), sd(0), sd(1), sd(2), sd(5),
      known * altimeter.bias_m, known * altimeter.bias_sd_m, known * altimeter.innovation_m,
      altimeter.faulty ? 1 : 0, kDriftSuspectNames.name(altimeter.drifts).data(),
      pose.localisability.weak_count(), static_cast<double>(weakest.strength), part(0), part(1), part(2),
      part(3), part(4), part(5), any ? kHolderNames.name(weakest.holder).data() : "none",
      known * altimeter.airflow_s2_m, known * altimeter.airflow_sd_s2_m);
  return text_of(line, length);
}

/// Upper triangle, row by row. Nine digits: fewer could make a nearly singular matrix indefinite.
std::string_view covariance_line(const PoseEstimate& pose, Line& line) {
  int length = std::snprintf(line.data(), line.size(), "%lld", static_cast<long long>(pose.stamp_ns));
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      const auto at = static_cast<std::size_t>(length);
      length += std::snprintf(line.data() + at, line.size() - at, ",%.9g", pose.covariance(i, j));
    }
  }
  line[static_cast<std::size_t>(length++)] = '\n';
  return text_of(line, length);
}

// A run that begins in motion without wheels knows its place once its speed is found. What was said before is no
// trajectory, and would shift all of it against a reference.
bool knows_place(const PoseEstimate& pose) {
  constexpr double kUnknownM = 0.5;
  const double variance_m2 = std::max(pose.covariance(0, 0), pose.covariance(1, 1));
  return pose.mode != PoseMode::kInitializing || variance_m2 < kUnknownM * kUnknownM;
}

}  // namespace

PoseWriter::PoseWriter(const std::filesystem::path& directory, Start start, std::uint32_t session)
    : trajectory_(made_directory(directory) / name_of_session(kTrajectoryFile, session),
                  "# t_s x_m y_m z_m qx qy qz qw: base_link in " + name_of_session("map", session) + "\n",
                  start),
      status_header_(status_header(directory / name_of_session(kStatusFile, session), start)),
      status_(directory / name_of_session(kStatusFile, session), status_header_ + "\n", start),
      covariance_(directory / name_of_session(kCovarianceFile, session),
                  std::string(kCovarianceColumns) + "\n", start) {}

void PoseWriter::add(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m) {
  Line line;
  if (knows_place(pose)) trajectory_.add(trajectory_line(pose));
  const std::string_view status = status_line(pose, altimeter_height_m, altimeter_sd_m, line);
  const std::string_view kept = with_columns_of(status_header_, status);
  if (kept.size() == status.size()) {
    status_.add(status);
  } else {
    status_.add(std::string(kept) + "\n");
  }
  covariance_.add(covariance_line(pose, line));
  ++count_;
}

void PoseWriter::flush() {
  trajectory_.flush();
  status_.flush();
  covariance_.flush();
}

void PoseWriter::sync() {
  trajectory_.sync();
  status_.sync();
  covariance_.sync();
}

}  // namespace isobar::files
