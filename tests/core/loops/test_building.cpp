// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "core/loops/building.hpp"
#include "core/loops/pose_corrections.hpp"
#include "tests/core/loops/ring_run.hpp"

namespace isobar::test::test_building {
namespace {

Building building() { return {{}, {}, {}, RingRun::lidar_mount()}; }

/// Dead reckoning goes wrong by `x_m`, `y_m`, `z_m` after 30 m, where no scan sees it.
LiveError unseen(double x_m, double y_m, double z_m) {
  return [=](double way_m) {
    return way_m < 30.0 ? Eigen::Isometry3d::Identity()
                        : Eigen::Isometry3d(Eigen::Translation3d(x_m, y_m, z_m));
  };
}

void drive(RingRun& run, Building& building, double until_m, double air_m = 0.0) {
  while (run.way_m() < until_m) {
    const RegisteredScan& scan = run.next();
    building.add(scan, AirHeight{run.way_m() < 30.0 ? 0.6 : 0.6 + air_m, 1e-4});
  }
}

/// Error of the corrected pose of a key scan at a way [m].
double error_m(const Building& building, const LiveError& error, double way_m) {
  const PoseCorrections corrections(building.corrections());
  const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(way_m * 1e9);
  const Eigen::Isometry3d corrected = corrections.corrected(stamp_ns, error(way_m) * ring_pose(way_m));
  return (corrected.translation() - ring_pose(way_m).translation()).norm();
}

TEST_CASE("a round that closes 40 cm off is corrected, and what came before the error stays") {
  const LiveError error = unseen(0.3, 0.26, 0.0);
  RingRun run(error);
  auto building = test_building::building();
  drive(run, building, 29.0);
  run.carry(9.0);
  drive(run, building, 60.0);
  REQUIRE(building.counts().taken > 0);
  // The ICP leaves some centimetres at most: the chain's and the loops' noise. Uncorrected it is 40 cm.
  CHECK(error_m(building, error, 20.0) < 0.03);
  CHECK(error_m(building, error, 45.0) < 0.05);
  CHECK(error_m(building, error, 58.0) < 0.05);
}

TEST_CASE("a round that closes is not moved by its loops") {
  const LiveError none = unseen(0.0, 0.0, 0.0);
  RingRun run(none);
  auto building = test_building::building();
  drive(run, building, 60.0);
  REQUIRE(building.counts().taken > 0);
  // The noise of chain and loops: 1 cm over the ring.
  for (const double way_m : {10.0, 30.0, 45.0, 58.0}) CHECK(error_m(building, none, way_m) < 0.015);
}

TEST_CASE("a floor that looks the same matches no other floor") {
  const double storey_m = 3.2;
  const LiveError error = unseen(0.0, 0.0, storey_m);
  RingRun run(error);
  auto building = test_building::building();
  drive(run, building, 29.0, storey_m);
  run.carry(9.0);
  drive(run, building, 70.0, storey_m);
  CHECK(building.counts().tried == 0);
  CHECK(building.corrections().empty());
}

TEST_CASE("the same drive gives the same corrections to the bit") {
  const LiveError error = unseen(0.2, 0.0, 0.0);
  const auto corrections = [&] {
    RingRun run(error);
    auto building = test_building::building();
    drive(run, building, 29.0);
    run.carry(9.0);
    drive(run, building, 60.0);
    return building.corrections();
  };
  const auto first = corrections();
  const auto second = corrections();
  REQUIRE(!first.empty());
  REQUIRE(first.size() == second.size());
  CHECK(std::equal(first.begin(), first.end(), second.begin(),
                   [](const CorrectedKey& a, const CorrectedKey& b) {
                     return a.T_map_base_corrected.matrix() == b.T_map_base_corrected.matrix();
                   }));
}

}  // namespace
}  // namespace isobar::test::test_building
