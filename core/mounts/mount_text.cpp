// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/mount_text.hpp"

#include <array>
#include <charconv>

#include "core/geometry.hpp"
#include "core/mounts/corrected_mount.hpp"

namespace isobar {

namespace {

std::string fixed_text(double value, int decimals) {
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  const std::string out(text.data(), end.ptr);
  return out.find_first_of("123456789") == std::string::npos && out.starts_with('-') ? out.substr(1) : out;
}

std::string scale_line(const char* what, const WheelScale& scale) {
  if (scale.sigma <= 0.0) return "";
  return std::string("# wheels: true ") + what + " = " + fixed_text(scale.scale, 4) + " x theirs, +- " +
         fixed_text(scale.sigma, 4) + "\n";
}

}  // namespace

std::string rpy_text(const Eigen::Vector3d& rpy_deg) {
  std::string text;
  for (const double angle_deg : rpy_deg) text += (text.empty() ? "" : ", ") + fixed_text(angle_deg, 2);
  return "[" + text + "]";
}

std::string mount_line(const MountState& mount, const Eigen::Vector3d& configured_rpy_deg) {
  Eigen::Vector3d error_rad(mount.error_rad[0], mount.error_rad[1], mount.error_rad[2]);
  if (!mount.yaw_found) error_rad.z() = 0.0;
  const auto sigma = [&](std::size_t axis) { return fixed_text(mount.sigma_rad[axis] / kRadPerDeg, 2); };
  return "lidar.rpy_deg = " + rpy_text(corrected_rpy_deg(configured_rpy_deg, error_rad)) + "  # +- " +
         sigma(0) + ", " + sigma(1) + ", " + (mount.yaw_found ? sigma(2) : "?") + "; was " +
         rpy_text(configured_rpy_deg);
}

std::string mounts_file_text(const MountState& mount, const Eigen::Vector3d& configured_rpy_deg) {
  std::string text =
      "# Mounts as this run found them, with 1 sigma [deg]: a file for conf.d, or lines for isobar.toml.\n";
  text += mount.found ? mount_line(mount, configured_rpy_deg) + "\n"
                      : "# lidar.rpy_deg: not found; it needs two turns of 90 deg or more between walls\n";
  if (mount.found && !mount.yaw_found) text += "# yaw: not found; it needs wheels and some straight metres\n";
  text += scale_line("distance", mount.wheel_distance);
  text += scale_line("turn", mount.wheel_turn);
  if (mount.wheel_turn.sigma > 0.0) text += "# the second is nominal over effective track width\n";
  return text;
}

}  // namespace isobar
