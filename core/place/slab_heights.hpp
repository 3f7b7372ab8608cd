// SPDX-License-Identifier: BSD-3-Clause
// Heights at which a robot may stand whose altimeter does not tell the floor.
#pragma once

#include <vector>

#include "core/place/slab_image.hpp"
#include "core/place/structure_map.hpp"

namespace isobar {

/// The height itself where 3 sigma are less than half a storey; else the levels of ground in the map within 3 sigma, by
/// their area, at most kMostSlabs, none nearer than 0.6 m to another. `base_above_ground_m`: of base_link where the robot
/// stands. Sloping ground has no levels: there the search may miss heights, which is why sigma is small outdoors.
[[nodiscard]] std::vector<SlabHeight> slab_heights(const StructureMap& map, const SlabHeight& height,
                                                   double base_above_ground_m);
inline constexpr std::size_t kMostSlabs = 8;

}  // namespace isobar
