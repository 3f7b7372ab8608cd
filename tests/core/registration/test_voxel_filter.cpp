// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>

#include "core/registration/voxel_filter.hpp"

namespace isobar::test::test_voxel_filter {

namespace {

using isobar::ScanPoint;
using isobar::VoxelFilter;
using isobar::VoxelGrid;

ScanPoint at(float x_m, float y_m, float z_m) { return {x_m, y_m, z_m, 0, 0, 0}; }

}  // namespace

TEST_CASE("two points share a voxel if and only if they lie in the same cube") {
  std::mt19937 random(21);
  // Steps of 1/128 m: exact in single precision, also with the grid's 500 m added.
  std::uniform_int_distribution<int> step(-384, 383);
  const auto place = [&] { return static_cast<float>(step(random)) / 128.0F; };
  const VoxelGrid grid(0.5F);
  std::set<std::uint64_t> voxels;
  std::set<std::tuple<int, int, int>> cubes;
  for (int i = 0; i < 20'000; ++i) {
    const ScanPoint p = at(place(), place(), place());
    const auto cube = [](float along_m) { return static_cast<int>(std::floor(along_m / 0.5F)); };
    const bool new_voxel = voxels.insert(grid.voxel_of(p)).second;
    CHECK(new_voxel == cubes.insert({cube(p.x_m), cube(p.y_m), cube(p.z_m)}).second);
  }
  CHECK(voxels.size() == 12 * 12 * 12);
}

TEST_CASE("points beyond 500 m or not finite have no voxel; the farthest corners have distinct ones") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float edge_m : {0.001F, 0.1F, 3.0F}) {
    const VoxelGrid grid(edge_m);
    for (const float bad : {nan, infinity, -infinity, 500.0F, -500.0F, 3e38F}) {
      CHECK(grid.voxel_of(at(bad, 0.0F, 0.0F)) == VoxelGrid::kNowhere);
      CHECK(grid.voxel_of(at(0.0F, bad, 0.0F)) == VoxelGrid::kNowhere);
      CHECK(grid.voxel_of(at(0.0F, 0.0F, bad)) == VoxelGrid::kNowhere);
    }
    std::set<std::uint64_t> corners;
    for (const float x_m : {-499.9F, 499.9F}) {
      for (const float y_m : {-499.9F, 499.9F}) {
        for (const float z_m : {-499.9F, 499.9F}) {
          corners.insert(grid.voxel_of(at(x_m, y_m, z_m)));
        }
      }
    }
    CHECK(corners.size() == 8);
  }
}

TEST_CASE("the filter acts as a set in every pass, a small one after a large one and vice versa") {
  std::mt19937_64 random(22);
  VoxelFilter filter(40'000);
  for (const std::uint64_t different : {10ULL, 30'000ULL, 5ULL, 2'000ULL, 0ULL, 40'000ULL}) {
    filter.start();
    std::set<std::uint64_t> reference;
    for (std::uint64_t i = 0; i < 3 * different; ++i) {
      // Neighbours along an axis, as on a surface: the worst case of a weak hash.
      const std::uint64_t voxel = (random() % different) << 15U | 7U;
      REQUIRE(filter.first(voxel) == reference.insert(voxel).second);
    }
  }
}

TEST_CASE("a full filter inserts nothing more and keeps its content") {
  VoxelFilter filter(3'000);
  filter.start();
  for (std::uint64_t voxel = 0; voxel < 3'000; ++voxel) {
    REQUIRE(filter.first(voxel));
  }
  CHECK_FALSE(filter.first(3'000));
  CHECK_FALSE(filter.first(2'999));
  filter.start();
  CHECK(filter.first(3'000));
}

}  // namespace isobar::test::test_voxel_filter
