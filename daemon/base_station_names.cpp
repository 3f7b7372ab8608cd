// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_station_names.hpp"

#include <algorithm>
#include <cstddef>

#include "core/printable_text.hpp"

namespace isobar {

namespace {

std::string quoted(const files::StationNames& names) {
  std::string text;
  for (const std::string& name : names) {
    if (!name.empty()) text += (text.empty() ? "\"" : " and \"") + printable(name) + "\"";
  }
  return text;
}

bool has_any(const files::StationNames& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) { return !name.empty(); });
}

/// As a checkpoint keeps it.
std::string kept(const std::string& name) { return name.substr(0, files::kMostStationBytes); }

}  // namespace

files::StationNames station_names(const Config& config) {
  return {config.dds.base_station, config.dds.second_base_station};
}

std::string take_over_stations(files::Checkpoint& checkpoint, const files::StationNames& names) {
  const HeightDatum stored = checkpoint.datum;
  const files::StationNames stored_names = checkpoint.stations;
  if (!stored.known || !has_any(stored_names) || !has_any(names)) return {};
  HeightDatum& datum = checkpoint.datum;
  datum.station_known = {};
  datum.station_offset_log = {};
  bool any = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    checkpoint.stations[i] = names[i];
    const auto at = std::find(stored_names.begin(), stored_names.end(), kept(names[i]));
    if (names[i].empty() || at == stored_names.end()) continue;
    const auto j = static_cast<std::size_t>(at - stored_names.begin());
    datum.station_known[i] = stored.station_known[j];
    datum.station_offset_log[i] = stored.station_offset_log[j];
    any = any || stored.station_known[j];
  }
  if (any) return {};
  datum = HeightDatum();
  return "the heights of the map refer to the base station " + quoted(stored_names) +
         ", this run listens to " + quoted(names) +
         ": no height is known before the place is found by the scans";
}

}  // namespace isobar
