// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/hill_site.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "simulation/city_furniture.hpp"

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kPatchM = 10.0;    // side of a patch
constexpr int kCells = 5;           // ground cells along the side of a patch: 2 m each
constexpr double kReachM = 105.0;   // the lidar's range
constexpr double kClearM = 1.4;     // free of plants on both sides of the way
constexpr double kUnevenM = 0.015;  // rms of the ground around the smooth terrain

using Patch = std::pair<int, int>;

Patch patch_at(const Vector2d& at_m) {
  return {static_cast<int>(std::floor(at_m.x() / kPatchM)), static_cast<int>(std::floor(at_m.y() / kPatchM))};
}

std::uint64_t index_of(int x, int y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U) | static_cast<std::uint32_t>(y);
}

/// Way in plan, by patch: for the distance from plants.
class Lane {
 public:
  explicit Lane(const std::vector<RawPose>& way) {
    constexpr std::size_t kEvery = 4;  // 0.2 s: at most 0.4 m
    for (std::size_t i = 0; i < way.size(); i += kEvery) {
      const Vector2d at(way[i].x_m, way[i].y_m);
      points_[patch_at(at)].push_back(at);
    }
  }

  [[nodiscard]] bool is_clear(const Vector2d& at_m, double radius_m) const {
    const double least_m = kClearM + radius_m;
    const Patch centre = patch_at(at_m);
    for (int x = centre.first - 1; x <= centre.first + 1; ++x) {
      for (int y = centre.second - 1; y <= centre.second + 1; ++y) {
        const auto found = points_.find({x, y});
        if (found == points_.end()) continue;
        for (const Vector2d& point : found->second) {
          if ((point - at_m).norm() < least_m) return false;
        }
      }
    }
    return true;
  }

  /// All patches within the lidar's range.
  [[nodiscard]] std::set<Patch> seen() const {
    std::set<Patch> patches;
    const int reach = static_cast<int>(std::ceil(kReachM / kPatchM));
    for (const auto& [centre, points] : points_) {
      for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
          if (std::hypot(x, y) <= reach) patches.insert({centre.first + x, centre.second + y});
        }
      }
    }
    return patches;
  }

 private:
  std::map<Patch, std::vector<Vector2d>> points_;
};

class HillBuilder {
 public:
  HillBuilder(const Terrain& terrain, const std::vector<RawPose>& way, std::uint64_t seed)
      : terrain_(terrain), lane_(way), seed_(seed) {}

  [[nodiscard]] Mesh build() {
    for (const Patch& patch : lane_.seen()) {
      add_ground(patch);
      add_plants(patch);
    }
    return std::move(mesh_);
  }

 private:
  /// Corner of a ground cell; x and y count cells.
  [[nodiscard]] Vector3d corner(int x, int y) const {
    const Vector2d at = kPatchM / kCells * Vector2d(x, y);
    Random uneven(seed_, "hill ground", index_of(x, y));
    return {at.x(), at.y(), terrain_.height_m(at) + uneven.normal(kUnevenM)};
  }

  void add_ground(const Patch& patch) {
    for (int x = kCells * patch.first; x < kCells * (patch.first + 1); ++x) {
      for (int y = kCells * patch.second; y < kCells * (patch.second + 1); ++y) {
        mesh_.quad(corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1),
                   Surface::kConcrete);
      }
    }
  }

  /// Woods and meadows: waves of the density of plants, 0 … 1.
  [[nodiscard]] double density(const Vector2d& at_m) const {
    Random of_hill(seed_, "hill woods");
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double number = 2.0 * std::numbers::pi / of_hill.uniform(60.0, 160.0);
      const double direction = of_hill.uniform(0.0, 2.0 * std::numbers::pi);
      const double phase = of_hill.uniform(0.0, 2.0 * std::numbers::pi);
      sum += std::sin(number * (std::cos(direction) * at_m.x() + std::sin(direction) * at_m.y()) + phase);
    }
    return std::clamp(0.45 + 0.35 * sum, 0.08, 1.0);
  }

  void add_plants(const Patch& patch) {
    Random random(seed_, "hill plants", index_of(patch.first, patch.second));
    const Vector2d low = kPatchM * Vector2d(patch.first, patch.second);
    const double dense = density(low);
    const auto place = [&](double radius_m) -> std::optional<Vector3d> {
      const Vector2d at = low + kPatchM * Vector2d(random.uniform(), random.uniform());
      if (!lane_.is_clear(at, radius_m)) return std::nullopt;
      return Vector3d(at.x(), at.y(), terrain_.height_m(at));
    };
    // Per hectare: up to 180 trees, 120 bushes and 50 rocks.
    for (double left = 1.8 * dense; random.chance(left); left -= 1.0) {
      // The crowns begin above the robot: only the trunk needs room.
      if (const auto foot = place(0.4)) add_tree(mesh_, *foot, random);
    }
    for (double left = 1.2 * dense; random.chance(left); left -= 1.0) {
      const double radius = random.uniform(0.4, 1.3);
      if (const auto foot = place(radius)) add_bush(*foot, radius, random);
    }
    if (random.chance(0.5)) {
      const double radius = random.uniform(0.2, 0.9);
      if (const auto foot = place(radius)) add_rock(*foot, radius, random);
    }
  }

  /// Leaves in a flattened ball on the ground.
  void add_bush(const Vector3d& foot, double radius_m, Random& random) {
    constexpr int kLeaves = 45;
    for (int i = 0; i < kLeaves; ++i) {
      const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double z = random.uniform(0.0, 1.0);
      const double reach = radius_m * std::cbrt(random.uniform(0.2, 1.0));
      const double flat = reach * std::sqrt(1.0 - z * z);
      const Vector3d leaf =
          foot + Vector3d(flat * std::cos(azimuth), flat * std::sin(azimuth), 1.2 * reach * z);
      std::array<Vector3d, 3> corners;
      for (Vector3d& at : corners) {
        for (int axis = 0; axis < 3; ++axis) at[axis] = leaf[axis] + random.uniform(-0.22, 0.22);
      }
      mesh_.triangle(corners[0], corners[1], corners[2], Surface::kWood);
    }
  }

  /// A boulder: rings of uneven corners around an axis, its foot in the ground.
  void add_rock(const Vector3d& foot, double radius_m, Random& random) {
    constexpr int kAround = 7;
    constexpr std::array<double, 3> kRing{1.0, 0.85, 0.4};      // radius
    constexpr std::array<double, 3> kHeight{-0.3, 0.35, 0.75};  // height, in radii
    std::array<std::array<Vector3d, kAround>, 3> corners;
    for (std::size_t ring = 0; ring < corners.size(); ++ring) {
      for (std::size_t i = 0; i < kAround; ++i) {
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kAround;
        const double reach = radius_m * kRing[ring] * random.uniform(0.75, 1.25);
        corners[ring][i] = foot + Vector3d(reach * std::cos(angle), reach * std::sin(angle),
                                           radius_m * (kHeight[ring] + random.uniform(-0.1, 0.1)));
      }
    }
    const Vector3d top = foot + Vector3d(0.0, 0.0, radius_m * random.uniform(0.8, 1.0));
    for (std::size_t i = 0; i < kAround; ++i) {
      const std::size_t next = (i + 1) % kAround;
      for (std::size_t ring = 0; ring + 1 < corners.size(); ++ring) {
        mesh_.quad(corners[ring][i], corners[ring][next], corners[ring + 1][next], corners[ring + 1][i],
                   Surface::kConcrete);
      }
      mesh_.triangle(corners.back()[i], corners.back()[next], top, Surface::kConcrete);
    }
  }

  const Terrain& terrain_;
  Lane lane_;
  std::uint64_t seed_;
  Mesh mesh_;
};

}  // namespace

Mesh build_hill(const Terrain& terrain, const std::vector<RawPose>& way, std::uint64_t seed) {
  return HillBuilder(terrain, way, seed).build();
}

}  // namespace isobar::simulation
