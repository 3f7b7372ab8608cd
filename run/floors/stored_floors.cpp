// SPDX-License-Identifier: BSD-3-Clause
#include "run/floors/stored_floors.hpp"

#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "run/evaluation/trajectory.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"

namespace isobar::files {

namespace {

/// True if a line is no comment: a run that has just begun has none.
bool has_pose(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.starts_with('#') && line.find_first_not_of(" \t\r") != std::string::npos) return true;
  }
  return false;
}

/// Points of a map are at the thirds of its cells.
double surface_m(const MapHeader& header) { return header.cell_m / 3.0; }

}  // namespace

std::filesystem::path trajectory_of_map(const std::filesystem::path& map_directory) {
  std::error_code error;
  const std::filesystem::path map = std::filesystem::absolute(map_directory, error).lexically_normal();
  const std::filesystem::path folder = map.has_filename() ? map : map.parent_path();
  const std::string name = folder.filename().string();
  if (!name.starts_with(kMapDirectory)) return {};
  const std::string number = name.substr(std::string_view(kMapDirectory).size());  // "", "_2" …
  const std::filesystem::path file =
      folder.parent_path() / (std::filesystem::path(kTrajectoryFile).stem().string() + number + ".tum");
  return std::filesystem::exists(file, error) ? file : std::filesystem::path{};
}

std::vector<Eigen::Vector3d> path_of(const std::filesystem::path& trajectory) {
  std::vector<Eigen::Vector3d> path;
  if (trajectory.empty()) return path;
  const std::string text = read_text_file(trajectory);
  if (!has_pose(text)) return path;
  for (const evaluation::StampedPose& pose : evaluation::parse_tum(text, trajectory.string()).poses) {
    path.push_back(pose.position_m);
  }
  return path;
}

StoredFloors find_stored_floors(FileTileStore& store, const std::vector<Eigen::Vector3d>& path) {
  StoredFloors found;
  found.read = for_each_tile(store, store.header(), std::nullopt,
                             [&](std::span<const MapPoint> points) { found.ground.add(points); });
  found.ground.finish();
  found.floors = find_floors(found.ground, path);
  return found;
}

OccupancyGrid stored_floor_grid(FileTileStore& store, const StoredFloors& found, const Floor& floor,
                                const std::vector<Eigen::Vector3d>& path, GridConfig config) {
  config.surface_m = surface_m(store.header());
  FloorGrid grid(found.ground, found.floors, floor, path, config);
  constexpr double kFar = std::numeric_limits<double>::max();
  const Floors::Slab slab = found.floors.slab_of(floor);
  const MapBox box{{-kFar, -kFar, slab.lowest_m - 1.0},
                   {kFar, kFar, slab.highest_m + config.robot_height_m + 1.0}};
  for_each_tile(store, store.header(), box, [&](std::span<const MapPoint> points) { grid.add(points); });
  return grid.finish();
}

}  // namespace isobar::files
