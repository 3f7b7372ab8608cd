// SPDX-License-Identifier: BSD-3-Clause
// Heights of two map frames by their air pressure: both have measured against one base station.
#pragma once

#include <optional>

#include "core/altitude/height_datum.hpp"
#include "core/merge/place_finder.hpp"

namespace isobar::files {

/// Height of the origin of map B in map A: where both read the same pressure at one pressure of the base station,
///
///     z_a - z_b = scale (station_offset_log_a - station_offset_log_b) - (offset_a - offset_b)       (height_datum.hpp)
///
/// `sigma_m`: biases of both altimeters, and 4 % of the difference for the temperature of the air, which is taken as 15
/// degrees Celsius. Nothing where no base station is known to both, or both are more than a kilometre apart.
[[nodiscard]] std::optional<HeightRelation> height_relation(const HeightDatum& a, const HeightDatum& b);

}  // namespace isobar::files
