// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>

#include "core/registration/scan_preparation.hpp"
#include "tests/core/registration/synthetic_world.hpp"

namespace isobar::test::test_scan_preparation {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

Eigen::Isometry3d turning(std::int64_t stamp_ns) {
  const double t = static_cast<double>(stamp_ns - kStart) * 1e-9;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(1.1 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << 0.7 * t, 0.1, 0.5;
  return T;
}

// Walls all around at up to 120 m, some nearer than the sensor's mount, some farther than the limit.
void fill(std::mt19937& random, std::uint32_t count, Scan& scan) {
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  scan.stamp_ns = kStart;
  scan.end_stamp_ns = kStart + 100'000'000;
  scan.point_count = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    const float range_m = uniform(random) < 0.05F ? 0.2F : 1.2F / (0.01F + 0.5F * uniform(random));
    scan.points[i] = {range_m * std::cos(6.28F * share),
                      range_m * std::sin(6.28F * share),
                      uniform(random) - 0.5F,
                      static_cast<std::uint16_t>(25'000.0F * share),
                      static_cast<std::uint8_t>(i % 16),
                      static_cast<std::uint8_t>(i % 251)};
  }
}

}  // namespace

TEST_CASE("one pass in parts gives the same bits as deskewing the whole scan and then thinning it") {
  std::mt19937 random(31);
  PriorHistory history;
  for (std::int64_t t = -50'000'000; t <= 150'000'000; t += 5'000'000) {
    history.add(perfect_prior(turning, kStart + t));
  }
  const Eigen::Isometry3d T_base_lidar(Eigen::Translation3d(0.1, 0.0, 0.4));
  Deskewer deskewer(T_base_lidar, 0.3, 80.0);
  Sampler whole(0.1, 600);
  Sampler in_parts(0.1, 600);
  auto scan = std::make_unique<Scan>();
  auto expected = std::make_unique<RegisteredScan>();
  auto out = std::make_unique<RegisteredScan>();
  // Sizes around that of a part, and the largest; the sampler carries its grid from scan to scan.
  for (const std::uint32_t count : {20'000U, 0U, 1U, 511U, 512U, 513U, 20'000U, Scan::kMaxPoints}) {
    fill(random, count, *scan);
    ScanMotion motion;
    REQUIRE(history.at(scan->end_stamp_ns, motion.end));
    deskewer.start(*scan, history, motion);
    const std::size_t kept = deskewer.move({scan->points, scan->point_count}, expected->points);
    whole.start(*expected);
    whole.add({expected->points, kept}, *expected);
    whole.finish(*expected);
    out->point_count = 12'345;  // stale content of the buffer
    prepare_scan(*scan, history, motion, deskewer, in_parts, *out);
    REQUIRE(out->point_count == expected->point_count);
    CHECK(std::memcmp(out->points, expected->points, out->point_count * sizeof(ScanPoint)) == 0);
    REQUIRE(in_parts.sample().size() == whole.sample().size());
    for (std::size_t i = 0; i < whole.sample().size(); ++i) {
      REQUIRE(in_parts.sample()[i] == whole.sample()[i]);
    }
    CHECK((count < 600 || out->point_count > 300));
  }
}

TEST_CASE("a point count beyond the capacity of a scan is clamped to it") {
  std::mt19937 random(32);
  auto scan = std::make_unique<Scan>();
  auto out = std::make_unique<RegisteredScan>();
  fill(random, Scan::kMaxPoints, *scan);
  scan->point_count = 0xFFFFFFFFU;
  Deskewer deskewer(Eigen::Isometry3d::Identity(), 0.3, 80.0);
  Sampler sampler(0.02, 600);
  prepare_scan(*scan, PriorHistory(), ScanMotion{}, deskewer, sampler, *out);
  CHECK(out->point_count > 10'000);
  CHECK(out->point_count <= RegisteredScan::kMaxPoints);
}

}  // namespace isobar::test::test_scan_preparation
