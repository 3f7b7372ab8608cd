// SPDX-License-Identifier: BSD-3-Clause
// The JSON of /api/view and of the live events; its fields are in docs/web.md.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "config/config_layer.hpp"
#include "core/floors/floor.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/floors/floor_names.hpp"
#include "tools/web/map_tiles.hpp"
#include "tools/web/pose_rows.hpp"

namespace isobar::web {

/// A value rounded to this number of decimals; null where it is not finite.
[[nodiscard]] nlohmann::ordered_json rounded(double value, int decimals);

/// Seconds after `origin_ns`, to 0.1 ms.
[[nodiscard]] double seconds_after(std::int64_t stamp_ns, std::int64_t origin_ns);

/// Columns of poses.
[[nodiscard]] nlohmann::ordered_json poses_json(const std::vector<PoseRow>& rows, std::int64_t origin_ns);
/// Columns of a line in space, thinned.
[[nodiscard]] nlohmann::ordered_json track_json(const std::string& name,
                                                const evaluation::Trajectory& trajectory,
                                                std::int64_t origin_ns);
/// Number, name and height of each floor.
[[nodiscard]] nlohmann::ordered_json floors_json(const std::vector<Floor>& floors,
                                                 const files::FloorNames& names);
[[nodiscard]] nlohmann::ordered_json map_json(const MapState& map);

/// An entry of health made here: for what a file says of itself.
[[nodiscard]] nlohmann::ordered_json note_json(const std::string& name, const std::string& level,
                                               const std::string& message);

/// Every setting with unit, meaning and where its value comes from.
/// @param from the files that say so; null: no file could be read
/// @param unknown_source what is said of a value that is neither the default nor in `from`
[[nodiscard]] nlohmann::ordered_json settings_json(const Config& in_force, const LoadedConfig* from,
                                                   const std::string& unknown_source);

/// Texts that are no UTF-8 do not end the program.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& json);

/// An object of /api/view with every field, empty ones where nothing is known.
/// @param kind "live", "run" or "recording"
[[nodiscard]] nlohmann::ordered_json empty_view(const std::string& kind, const std::string& title,
                                                std::int64_t origin_ns);

}  // namespace isobar::web
