// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "run/files/replay_output.hpp"

namespace isobar::files {

namespace {

static_assert(std::endian::native == std::endian::little, "map.ply is written as the machine holds it");

/// The header always has the same length, whatever the count: a comment takes up the slack.
std::string ply_header(std::uint64_t count) {
  constexpr std::size_t kCountDigits = 20;
  const std::string digits = std::to_string(count);
  return "ply\nformat binary_little_endian 1.0\ncomment isobar map, metres, z up\nelement vertex " + digits +
         "\ncomment " + std::string(kCountDigits - digits.size(), '.') +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\nend_header\n";
}

std::filesystem::path made_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw ServiceError(directory.string() + ": cannot be created: " + error.message());
  return directory;
}

}  // namespace

PlyWriter::PlyWriter(const std::filesystem::path& file) : file_(file) { file_.write(ply_header(0)); }

void PlyWriter::add(float x_m, float y_m, float z_m, float intensity) {
  const std::array<float, 4> vertex{x_m, y_m, z_m, intensity};
  file_.write(vertex.data(), sizeof(vertex));
  ++count_;
}

void PlyWriter::close() {
  if (!file_.is_open()) return;
  file_.seek(0);
  file_.write(ply_header(count_));
  file_.close();
}

ReplayOutputWriter::ReplayOutputWriter(const std::filesystem::path& directory)
    : directory_(made_directory(directory)),
      trajectory_(directory_ / "trajectory.tum"),
      status_(directory_ / "status.csv") {
  trajectory_.write("# t_s x_m y_m z_m qx qy qz qw: base_link in map\n");
  status_.write(std::string(kStatusColumns) + "\n");
}

void ReplayOutputWriter::add(const PoseEstimate& pose, double altimeter_height_m, double altimeter_sd_m) {
  constexpr long long kNsPerS = 1'000'000'000;
  std::array<char, 8192> line;  // holds every column at 1e308

  const auto sd = [&](int axis) { return std::sqrt(std::max(0.0, pose.covariance(axis, axis))); };
  const Eigen::Vector3d p = pose.T_map_base.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.T_map_base.linear()).normalized();
  const auto stamp_ns = static_cast<long long>(pose.stamp_ns);
  int length = std::snprintf(line.data(), line.size(), "%s%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                             stamp_ns < 0 ? "-" : "", std::llabs(stamp_ns / kNsPerS),
                             std::llabs(stamp_ns % kNsPerS), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  trajectory_.write(line.data(), std::min(static_cast<std::size_t>(length), line.size() - 1));
  const Eigen::Vector3d& eigenvalues = pose.smallest_eigenvalues;
  length = std::snprintf(
      line.data(), line.size(),
      "%lld,%u,%s,%s,%s,%d,%u,%u,%u,%.4f,%.6f,%.6g,%.6g,%.6g,%.3f,%.4f,%.4f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%."
      "6g\n",
      stamp_ns, pose.sequence, mode_name(pose.mode).data(), method_name(pose.effective_method).data(),
      height_source_name(pose.height_source).data(), pose.degenerate ? 1 : 0, pose.iterations,
      pose.sampled_points, pose.matched_pairs, pose.overlap, pose.residual_rms_m, eigenvalues[0],
      eigenvalues[1], eigenvalues[2], pose.registration_ms, altimeter_height_m, altimeter_sd_m, p.x(), p.y(),
      p.z(), sd(0), sd(1), sd(2), sd(5));
  status_.write(line.data(), std::min(static_cast<std::size_t>(length), line.size() - 1));
  ++count_;
}

void ReplayOutputWriter::write_settings(std::string_view toml) const {
  write_text_file(directory_ / "settings.toml", toml);
}

void ReplayOutputWriter::close() {
  trajectory_.close();
  status_.close();
}

}  // namespace isobar::files
