// SPDX-License-Identifier: BSD-3-Clause
// Names of enumerators on every wire: files, topics, command line, configuration, log.
#pragma once

#include <string_view>

#include "core/estimates.hpp"

namespace isobar {

constexpr std::string_view method_name(Method method) {
  switch (method) {
    case Method::k6Dof:
      return "6dof";
    case Method::k4Dof:
      return "4dof";
    case Method::k3Dof:
      return "3dof";
    case Method::k6DofAltitude:
      return "6dof-altitude";
    case Method::k4DofAltitude:
      return "4dof-altitude";
    case Method::kOdometry:
      return "odometry";
  }
  return "unknown";
}

constexpr std::string_view mode_name(PoseMode mode) {
  switch (mode) {
    case PoseMode::kRegistered:
      return "registered";
    case PoseMode::kPriorOnly:
      return "prior";
    case PoseMode::kInitializing:
      return "initializing";
  }
  return "unknown";
}

constexpr std::string_view height_source_name(HeightSource source) {
  switch (source) {
    case HeightSource::kDifferential:
      return "differential";
    case HeightSource::kSingleBarometer:
      return "single_barometer";
    case HeightSource::kHeld:
      return "held";
    case HeightSource::kNone:
      return "none";
  }
  return "unknown";
}

}  // namespace isobar
