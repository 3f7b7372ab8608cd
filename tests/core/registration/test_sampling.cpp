// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "core/registration/sampling.hpp"

namespace isobar::test::test_sampling {

namespace {

using isobar::RegisteredScan;
using isobar::Sampler;
using isobar::ScanPoint;

// Dense close by and sparse far away, as a lidar sees a plane: 20000 points.
void fill(RegisteredScan& scan) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  scan.point_count = 20'000;
  for (std::uint32_t i = 0; i < scan.point_count; ++i) {
    const float range = 1.0F / (0.02F + 0.9F * uniform(random));
    const float azimuth = 6.2831853F * uniform(random);
    scan.points[i] = ScanPoint{range * std::cos(azimuth), range * std::sin(azimuth), 0.0F, 0, 0, 0};
  }
}

// Thins a whole scan in place.
void thin(Sampler& sampler, RegisteredScan& scan) {
  const std::span<const ScanPoint> all(scan.points, scan.point_count);
  sampler.start(scan);
  sampler.add(all, scan);
  sampler.finish(scan);
}

}  // namespace

TEST_CASE("the map gets one point for each voxel that the scan reaches, in order") {
  auto scan = std::make_unique<RegisteredScan>();
  fill(*scan);
  const float first_x = scan->points[0].x_m;
  // Voxels of the grid that starts at -500 m.
  std::vector<std::array<int, 2>> voxels;
  for (std::uint32_t i = 0; i < scan->point_count; ++i) {
    voxels.push_back({static_cast<int>((scan->points[i].x_m + 500.0F) * 5.0F),
                      static_cast<int>((scan->points[i].y_m + 500.0F) * 5.0F)});
  }
  std::sort(voxels.begin(), voxels.end());
  const auto reached = std::unique(voxels.begin(), voxels.end()) - voxels.begin();
  Sampler sampler(0.2, 1000);
  thin(sampler, *scan);
  CHECK(scan->point_count == static_cast<std::uint32_t>(reached));
  CHECK(scan->points[0].x_m == first_x);
}

TEST_CASE("a surface along a face of the grid keeps its place under the noise of the range") {
  // A ring of a floor whose height varies by +-1 cm along it, as a tilted robot sees it, about the face at z = 0 of the grid.
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.012F);
  auto scan = std::make_unique<RegisteredScan>();
  double slope_sum = 0.0;
  double slope_weight = 0.0;
  double sample_sum = 0.0;
  double sample_weight = 0.0;
  Sampler sampler(0.125, 2000);
  constexpr float kTilt = 0.003F;  // 0.17 deg
  for (int repeat = 0; repeat < 200; ++repeat) {
    scan->point_count = 0;
    for (int i = 0; i < 1800; ++i) {
      const float azimuth = 6.2831853F * static_cast<float>(i) / 1800.0F;
      const float x = 3.0F * std::cos(azimuth);
      scan->points[scan->point_count++] =
          ScanPoint{x, 3.0F * std::sin(azimuth), kTilt * x + noise(random), 0, 0, 0};
    }
    thin(sampler, *scan);
    for (std::uint32_t i = 0; i < scan->point_count; ++i) {
      slope_sum += static_cast<double>(scan->points[i].x_m * scan->points[i].z_m);
      slope_weight += static_cast<double>(scan->points[i].x_m * scan->points[i].x_m);
    }
    for (const Eigen::Vector3f& p : sampler.sample()) {
      sample_sum += static_cast<double>(p.x() * p.z());
      sample_weight += static_cast<double>(p.x() * p.x());
    }
  }
  // 60 000 points of 12 mm at a lever of 2 m give the slope to 2e-5; points chosen by their own voxel halve it.
  CHECK(std::abs(slope_sum / slope_weight - 0.003) < 0.0002);
  CHECK(std::abs(sample_sum / sample_weight - 0.003) < 0.0003);
}

TEST_CASE("the sample's size settles near its limit, never exceeds it, and includes far points") {
  Sampler sampler(0.1, 500);
  auto scan = std::make_unique<RegisteredScan>();
  for (int i = 0; i < 10; ++i) {
    fill(*scan);
    thin(sampler, *scan);
    CHECK(sampler.sample().size() <= 500);
  }
  CHECK(sampler.sample().size() > 350);
  std::size_t far = 0;
  for (const Eigen::Vector3f& p : sampler.sample()) {
    far += p.norm() > 10.0F ? 1 : 0;
  }
  // A tenth of the returns lie beyond 10 m, but most of the area does.
  CHECK(far > sampler.sample().size() / 4);
}

TEST_CASE("equal scans give equal samples") {
  auto a = std::make_unique<RegisteredScan>();
  fill(*a);
  auto b = std::make_unique<RegisteredScan>(*a);
  Sampler first(0.1, 300);
  Sampler second(0.1, 300);
  thin(first, *a);
  thin(second, *b);
  REQUIRE(first.sample().size() == second.sample().size());
  for (std::size_t i = 0; i < first.sample().size(); ++i) {
    CHECK(first.sample()[i] == second.sample()[i]);
  }
}

TEST_CASE("an empty scan and a scan of the largest size are both thinned") {
  auto scan = std::make_unique<RegisteredScan>();
  scan->point_count = 0;
  Sampler sampler(0.1, 300);
  thin(sampler, *scan);
  CHECK(sampler.sample().empty());
  scan->point_count = RegisteredScan::kMaxPoints;
  for (std::uint32_t i = 0; i < scan->point_count; ++i) {
    scan->points[i] = ScanPoint{static_cast<float>(i % 300), static_cast<float>(i / 300), 0.0F, 0, 0, 0};
  }
  thin(sampler, *scan);
  CHECK(scan->point_count == RegisteredScan::kMaxPoints);
  CHECK(sampler.sample().size() == 300);
}

}  // namespace isobar::test::test_sampling
