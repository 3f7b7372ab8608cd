// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/estimates.hpp"
#include "core/geometry.hpp"

namespace isobar {

/// Decides when the mount that was found is worth a line in the log: once, when its sigma is small enough to be pasted
/// into a file, and again only when it has moved by more than three of its sigmas since that line, or yaw has come.
class MountNews {
 public:
  /// Standard deviation of roll and pitch from which on the mount is said [rad].
  static constexpr double kSaidRad = 0.15 * kRadPerDeg;
  static constexpr double kMovedSigmas = 3.0;

  [[nodiscard]] bool is_news(const MountState& mount) {
    if (!mount.found || std::max(mount.sigma_rad[0], mount.sigma_rad[1]) > kSaidRad) return false;
    if (said_ && !moved(mount)) return false;
    said_ = true;
    last_ = mount;
    return true;
  }

 private:
  [[nodiscard]] bool moved(const MountState& mount) const {
    if (mount.yaw_found && !last_.yaw_found) return true;
    const std::size_t axes = mount.yaw_found ? 3 : 2;
    for (std::size_t i = 0; i < axes; ++i) {
      if (std::abs(mount.error_rad[i] - last_.error_rad[i]) > kMovedSigmas * last_.sigma_rad[i]) return true;
    }
    return false;
  }

  bool said_ = false;
  MountState last_;
};

}  // namespace isobar
