// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/section_builder.hpp"

namespace isobar {

/// Adds xyz_m, the position of a sensor in base_link.
inline void add_position(SectionBuilder& section, Mount& mount, const char* doc) {
  constexpr double kMaxLeverM = 100.0;
  section.number("xyz_m", &mount.xyz_m, "m", -kMaxLeverM, kMaxLeverM, doc).basic();
}

/// Adds rpy_deg, the rotation of a sensor in base_link.
inline void add_rotation(SectionBuilder& section, Mount& mount) {
  section
      .number("rpy_deg", &mount.rpy_deg, "deg", -360.0, 360.0,
              "Roll, pitch and yaw of the sensor in base_link, about the fixed axes x, y, z. 0: its axes are "
              "parallel to base_link's.")
      .basic();
}

}  // namespace isobar
