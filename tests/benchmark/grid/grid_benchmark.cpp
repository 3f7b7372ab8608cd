// SPDX-License-Identifier: BSD-3-Clause
// bench_grid: grids of a run's floors against the surfaces of its simulated recording, and their time.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/map/grid.hpp"
#include "run/evaluation/trajectory.hpp"
#include "run/files/stl_file.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/stored_floors.hpp"
#include "tests/benchmark/grid/true_section.hpp"

namespace isobar::bench {

namespace {

using evaluation::StampedPose;
using Square = TrueSection::Square;

/// CPU time of this process since another one [ms]: other processes do not count.
double ms_since(std::clock_t begin) {
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

Eigen::Isometry3d transform_of(const StampedPose& pose) {
  return Eigen::Translation3d(pose.position_m) * pose.attitude;
}

/// A pose of the run, and where the robot was in truth.
struct Anchor {
  Eigen::Vector3d p_map;
  Eigen::Isometry3d
      T_true_map;  ///< by this pose alone: the grid as the robot there needs it, without drift elsewhere
};

std::vector<Anchor> anchors_of(const evaluation::Trajectory& run, const evaluation::Trajectory& reference) {
  std::vector<Anchor> anchors;
  for (const StampedPose& pose : run.poses) {
    const auto at =
        std::lower_bound(reference.poses.begin(), reference.poses.end(), pose.stamp_ns,
                         [](const StampedPose& a, std::int64_t stamp) { return a.stamp_ns < stamp; });
    if (at == reference.poses.end() || at->stamp_ns - pose.stamp_ns > 20'000'000) continue;
    if (!anchors.empty() && (pose.position_m - anchors.back().p_map).norm() < 0.25) continue;
    anchors.push_back({pose.position_m, transform_of(*at) * transform_of(pose).inverse()});
  }
  return anchors;
}

struct Shares {
  std::size_t occupied = 0, near_wall = 0, on_wall = 0;
  std::size_t seen = 0, covered = 0;
  std::size_t free = 0, free_visible = 0;
};

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? NAN : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

class FloorTruth {
 public:
  FloorTruth(const TrueSection& section, std::vector<Anchor> anchors, double base_height_m,
             const GridConfig& config)
      : section_(section), anchors_(std::move(anchors)), base_height_m_(base_height_m), config_(config) {
    for (std::size_t i = 0; i < anchors_.size(); i += 4) cast_from(anchors_[i]);  // 1 m apart
  }

  [[nodiscard]] Shares compare(const OccupancyGrid& grid) const {
    Shares shares;
    std::set<std::pair<int, int>> drawn;
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const std::int8_t cell = grid.cells[grid.index(x, y)];
        if (cell == kCellUnknown) continue;
        const Eigen::Vector2d p_map =
            grid.origin_m + (Eigen::Vector2d(x, y).array() + 0.5).matrix() * grid.resolution_m;
        const Anchor& anchor = nearest(p_map);
        const Eigen::Vector3d p_true =
            anchor.T_true_map * Eigen::Vector3d(p_map.x(), p_map.y(), anchor.p_map.z());
        const Square square = TrueSection::square_of(p_true.head<2>());
        if (cell == kCellOccupied) {
          drawn.insert({square.x(), square.y()});
          add_occupied(square, p_true.z() - base_height_m_, shares);
        } else {
          ++shares.free;
          shares.free_visible += is_visible(square) ? 1 : 0;
        }
      }
    }
    for (const auto& [x, y] : seen_) {
      ++shares.seen;
      bool found = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) found = found || drawn.contains({x + dx, y + dy});
      }
      shares.covered += found ? 1 : 0;
    }
    return shares;
  }

 private:
  void add_occupied(const Square& square, double ground_m, Shares& shares) const {
    const double low = ground_m + 0.5 * config_.lowest_obstacle_m;
    const double high = ground_m + config_.robot_height_m + 0.1;
    ++shares.occupied;
    shares.near_wall += section_.is_near_wall(square, low, high, 1) ? 1 : 0;
    shares.on_wall += section_.is_wall(square, low, high) ? 1 : 0;
  }
  [[nodiscard]] const Anchor& nearest(const Eigen::Vector2d& p_map) const {
    return *std::min_element(anchors_.begin(), anchors_.end(), [&](const Anchor& a, const Anchor& b) {
      return (a.p_map.head<2>() - p_map).squaredNorm() < (b.p_map.head<2>() - p_map).squaredNorm();
    });
  }
  [[nodiscard]] bool is_visible(const Square& square) const {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (visible_.contains({square.x() + dx, square.y() + dy})) return true;
      }
    }
    return false;
  }
  // What the robot sees from here in truth: walls up to 8 m, free space up to 15 m.
  void cast_from(const Anchor& anchor) {
    const Eigen::Vector3d p = anchor.T_true_map * anchor.p_map;
    const double ground_m = p.z() - base_height_m_;
    for (int i = 0; i < 1440; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 1440;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      for (double way_m = 0.0; way_m < 15.0; way_m += 0.5 * TrueSection::kSquareM) {
        const Square square = TrueSection::square_of(p.head<2>() + way_m * direction);
        // Walls of the whole band: what stands lower or higher than the lidar looks is left out.
        if (section_.is_wall(square, ground_m + 0.45, ground_m + 0.65)) {
          if (way_m < 8.0) seen_.insert({square.x(), square.y()});
          break;
        }
        visible_.insert({square.x(), square.y()});
      }
    }
  }

  const TrueSection& section_;
  std::vector<Anchor> anchors_;
  double base_height_m_;
  GridConfig config_;
  std::set<std::pair<int, int>> seen_;
  std::set<std::pair<int, int>> visible_;
};

/// Floors and the grid of one floor from points in memory, as a live map has them: 50 m x 50 m around a place.
void measure_live(FileTileStore& store, const files::StoredFloors& found,
                  const std::vector<Eigen::Vector3d>& path) {
  const Eigen::Vector3d centre = path[path.size() / 2];
  const Eigen::Vector3d reach(25.0, 25.0, 70.0);
  std::vector<MapPoint> points;
  const files::MapBox box{centre - reach, centre + reach};
  files::for_each_tile(store, store.header(), box, [&](std::span<const MapPoint> more) {
    for (const MapPoint& point : more) {
      if (box.contains(point.p_map)) points.push_back(point);
    }
  });
  std::vector<Eigen::Vector3d> near;
  for (const Eigen::Vector3d& p : path) {
    if (box.contains(p)) near.push_back(p);
  }
  const FloorGuess guess = floor_at(found.floors, centre, 0.05);
  const auto begin = std::clock();
  const OccupancyGrid grid = floor_grid(points, found.floors, *guess.floor, near);
  std::printf("50 m x 50 m in memory: %zu points, %zu poses, %d x %d cells: %.0f ms\n", points.size(),
              near.size(), grid.width, grid.height, ms_since(begin));
}

void run(const std::string& recording, const std::string& run_folder) {
  const std::filesystem::path map = std::filesystem::path(run_folder) / "map";
  const auto store = FileTileStore::open_to_read(map);
  const auto trajectory = files::trajectory_of_map(map);
  const std::vector<Eigen::Vector3d> path = files::path_of(trajectory);
  auto begin = std::clock();
  const files::StoredFloors found = files::find_stored_floors(*store, path);
  std::printf("%zu floors of %llu points: %.0f ms, base_link %.3f m above the ground\n",
              found.floors.floors.size(), static_cast<unsigned long long>(found.read.points), ms_since(begin),
              found.floors.base_height_m);
  const auto read = [](const std::filesystem::path& file) {
    return evaluation::parse_tum(files::read_text_file(file), file.string());
  };
  const std::vector<Anchor> anchors =
      anchors_of(read(trajectory), read(std::filesystem::path(recording) / "reference.tum"));
  const TrueSection section(files::read_stl(std::filesystem::path(recording) / files::kSurfacesFile));
  std::printf(
      "floor  height m  grid cells    ms  occupied  on wall %%  within a cell %%  seen walls  covered %%  "
      "free in sight %%\n");
  for (const Floor& floor : found.floors.floors) {
    begin = std::clock();
    const GridConfig config;
    const OccupancyGrid grid = files::stored_floor_grid(*store, found, floor, path, config);
    const double ms = ms_since(begin);
    std::vector<Anchor> own;
    const Floors::Slab slab = found.floors.slab_of(floor);
    for (const Anchor& anchor : anchors) {
      if (slab.contains(anchor.p_map.z() - found.floors.base_height_m)) own.push_back(anchor);
    }
    const Shares shares = FloorTruth(section, own, found.floors.base_height_m, config).compare(grid);
    std::printf("%5d  %8.2f  %10zu  %4.0f  %8zu  %9.1f  %15.1f  %10zu  %9.1f  %15.1f\n", floor.number,
                floor.height_m, grid.cells.size(), ms, shares.occupied,
                percent(shares.on_wall, shares.occupied), percent(shares.near_wall, shares.occupied),
                shares.seen, percent(shares.covered, shares.seen), percent(shares.free_visible, shares.free));
  }
  measure_live(*store, found, path);
}

}  // namespace

}  // namespace isobar::bench

int main(int argc, char** argv) {
  CLI::App app("Grids of a run's floors against the true surfaces of its simulated recording");
  std::string recording;
  std::string run_folder;
  app.add_option("RECORDING", recording)->required();
  app.add_option("RUN", run_folder)->required();
  CLI11_PARSE(app, argc, argv);
  try {
    isobar::bench::run(recording, run_folder);
  } catch (const isobar::Error& error) {
    std::fprintf(stderr, "bench_grid: %s\n", error.what());
    return error.exit_code();
  }
  return 0;
}
