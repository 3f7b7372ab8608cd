// SPDX-License-Identifier: BSD-3-Clause
// Heights of two map frames by their air pressure: both have measured against one base station.
#pragma once

#include <filesystem>
#include <optional>

#include "core/altitude/height_datum.hpp"
#include "core/merge/place_finder.hpp"
#include "run/files/checkpoint.hpp"

namespace isobar::files {

/// Height of the origin of map B in map A: where both read the same pressure at one pressure of the base station,
///
///     z_a - z_b = scale (station_offset_log_a - station_offset_log_b) - (offset_a - offset_b)       (height_datum.hpp)
///
/// `sigma_m`: biases of both altimeters, and 4 % of the difference for the temperature of the air, which is taken as 15
/// degrees Celsius. Nothing where no base station is known to both, or both are more than a kilometre apart.
[[nodiscard]] std::optional<HeightRelation> height_relation(const HeightDatum& a, const HeightDatum& b);

/// The folder in which a map's folder lies: that of its run.
[[nodiscard]] std::filesystem::path run_folder_of(const std::filesystem::path& map_folder);
/// The checkpoint of a map: in its folder, or beside it in that of its run, where it is of this map frame. Nothing where there
/// is none.
/// @throws DataError for a damaged checkpoint
[[nodiscard]] std::optional<Checkpoint> checkpoint_of_map(const std::filesystem::path& map_folder);

}  // namespace isobar::files
