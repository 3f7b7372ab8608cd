// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// Notices that a robot may have been carried away: what it sees changes at once while its wheels stand. So does what a robot
/// sees before which a door opens: it is a reason to search the place, and no more. A robot that drives sees new rooms all
/// the time, and nobody carries it.
class CarriedWatch {
 public:
  /// Takes a scan that belongs to a known place, and the prior at it.
  /// @return true where the overlap falls
  bool add(const PoseEstimate& pose, const Prior& prior);
  void restart() { usual_overlap_ = 0.0; }

 private:
  double usual_overlap_ = 0.0;  // smoothed; 0: none yet
  std::int64_t drove_ns_ = 0;   // last scan at which the wheels turned
};

}  // namespace isobar
