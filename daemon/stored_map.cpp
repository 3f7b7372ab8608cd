// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/stored_map.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "daemon/base_station_names.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/run_output.hpp"
#include "run/floors/floor_names.hpp"

namespace isobar {

namespace fs = std::filesystem;

namespace {

fs::path map_folder_in(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / "map.toml", error)) return folder;
  for (std::uint32_t session = files::newest_session(folder); session > 0; --session) {
    fs::path map = files::RunOutput::map_directory(folder, session);
    if (fs::exists(map / "map.toml", error)) return map;
  }
  throw DataError(folder.string() + ": holds no map: neither map.toml nor a run with a folder map");
}

void refuse_other_grid(const fs::path& map, const MapHeader& header) {
  const MapHeader found = read_map_header(map);
  if (found == header) return;
  throw DataError((map / "map.toml").string() + ": the map has tiles of " + std::to_string(found.tile_m) +
                  " m with cells of " + std::to_string(found.cell_m) +
                  " m; the configuration requires tiles of " + std::to_string(header.tile_m) +
                  " m with cells of " + std::to_string(header.cell_m) + " m");
}

/// Files of a map that a copy has; map.toml, without which there is no map, is the last.
std::vector<fs::path> names_of_files(const fs::path& map) {
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(map)) {
    const fs::path name = entry.path().filename();
    const std::string extension = name.extension().string();
    const bool numbered =
        extension == kTilesExtension || extension == kScansExtension || extension == ".index";
    if (numbered || name == files::kFloorNamesFile || name == files::kCheckpointFile) names.push_back(name);
  }
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(map / kBuildingFolder, none)) {
    const fs::path name = entry.path().filename();
    if (name.extension() == kScansExtension || name == "building.log")
      names.push_back(kBuildingFolder / name);
  }
  std::sort(names.begin(), names.end());
  names.emplace_back("map.toml");
  return names;
}

}  // namespace

StoredMap find_stored_map(const fs::path& folder, const MapHeader& header,
                          const files::StationNames& stations) {
  StoredMap stored;
  stored.folder = map_folder_in(fs::absolute(folder).lexically_normal());
  refuse_other_grid(stored.folder, header);
  KnownPlace place;
  if (auto checkpoint = files::checkpoint_of_map(stored.folder)) {
    std::string other_station = take_over_stations(*checkpoint, stations);
    stored.start = continuation_of(*checkpoint);
    stored.start.other_station = std::move(other_station);
    place = *stored.start.place;
  }
  place.anywhere = true;
  place.session = stored.start.session = 1;
  place.v_map_m_s.setZero();
  place.yaw_rate_rad_s = 0.0;
  stored.has_datum = stored.start.datum.known;
  stored.start.place = place;
  return stored;
}

std::string height_note(const StoredMap& stored) {
  if (!stored.start.other_station.empty()) return stored.folder.string() + ": " + stored.start.other_station;
  if (stored.has_datum) return {};
  return stored.folder.string() + ": no height datum is stored with the map: all of its floors are searched";
}

void copy_map(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (fs::exists(to, error) && !file_numbers(to, kTilesExtension).empty()) {
    throw DataError(to.string() + ": holds tiles of a map already; " + from.string() +
                    " is not copied there");
  }
  try {
    const fs::path part = to.string() + ".part";
    fs::remove_all(part);
    fs::create_directories(part / kBuildingFolder);
    const std::vector<fs::path> names = names_of_files(from);
    for (const fs::path& name : names) fs::copy_file(from / name, part / name);
    fs::create_directories(to / kBuildingFolder);
    for (const fs::path& name : names) fs::rename(part / name, to / name);
    fs::remove_all(part);
  } catch (const fs::filesystem_error& failure) {
    throw ServiceError(to.string() + ": the map cannot be copied there: " + failure.what());
  }
  sync_folder(to);
}

std::shared_ptr<const KnownMap> read_known_map(FileTileStore& store, std::uint32_t session) {
  auto map = std::make_shared<KnownMap>(static_cast<float>(store.header().cell_m), session);
  std::vector<std::byte> bytes;
  for (const TileKey& key : store.keys()) {
    if (store.take(key, bytes)) map->add_tile(key, bytes);
  }
  map->finish();
  return map;
}

}  // namespace isobar
