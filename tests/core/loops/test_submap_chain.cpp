// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "core/loops/submap_chain.hpp"
#include "tests/core/loops/ring_run.hpp"

namespace isobar::test::test_submap_chain {
namespace {

SubmapChain chain() { return {{}, {}, {}, RingRun::lidar_mount()}; }

/// Pose of the last key scan in the first submap, along the chain.
Eigen::Isometry3d along_chain(const SubmapChain& chain) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (std::size_t i = 1; i <= chain.holder(); ++i) T = T * chain.link(i).T_before_submap;
  return T * chain.last_key().T_submap_base;
}

double error_m(const SubmapChain& chain, const RingRun& run) {
  const Eigen::Isometry3d T_first_base = ring_pose(0.0).inverse() * ring_pose(run.way_m());
  return (along_chain(chain).translation() - upright(T_first_base).translation()).norm();
}

Eigen::Isometry3d shift(double x_m, double y_m) {
  return Eigen::Isometry3d(Eigen::Translation3d(x_m, y_m, 0.0));
}

TEST_CASE("submaps follow each other after their spacing, overlap by half and hold every key scan once") {
  auto chain = test_submap_chain::chain();
  RingRun run;
  run.step_m = 0.25;  // half of the spacing of key scans
  std::size_t keys = 0;
  while (run.way_m() < 35.0) keys += chain.add(run.next(), std::nullopt).key ? 1 : 0;
  REQUIRE(chain.submaps().size() == 4);
  CHECK(chain.complete() == 2);  // of the last two, one holds the key scans and one is begun
  std::size_t held = 0;
  for (const Submap& submap : chain.submaps()) held += submap.keys.size();
  CHECK(held == keys);
  CHECK(keys >= 35.0 / KeyScanChoice::kDistanceM);  // and more where it turns
  CHECK(keys < 45.0 / KeyScanChoice::kDistanceM);
  for (std::size_t i = 1; i < 4; ++i) {
    const double spacing_m = chain.submaps()[i].first_way_m - chain.submaps()[i - 1].first_way_m;
    CHECK(spacing_m == doctest::Approx(SubmapConfig{}.spacing_m).epsilon(0.06));  // one key scan more at most
  }
}

TEST_CASE("on new ground the chain is the live motion, to rounding") {
  auto chain = test_submap_chain::chain();
  RingRun run;
  run.known_from_m = 100.0;
  while (run.way_m() < 30.0) chain.add(run.next(), std::nullopt);
  CHECK(error_m(chain, run) < 1e-9);
}

TEST_CASE("a live pose that is pulled onto an earlier visit does not enter the chain") {
  auto chain = test_submap_chain::chain();
  // 12 cm within two metres: the whole drift of a long way, taken up where the robot comes back.
  RingRun run([](double way_m) { return shift(0.0, -0.06 * std::clamp(way_m - 20.0, 0.0, 2.0)); });
  while (run.way_m() < 30.0) chain.add(run.next(), std::nullopt);
  // The ICP of a key scan is good to some millimetres; the live motion would leave 120 mm.
  CHECK(error_m(chain, run) < 0.03);
}

TEST_CASE("where nothing confirms the live motion, the link says so") {
  auto known = test_submap_chain::chain();
  auto carried = test_submap_chain::chain();
  RingRun driven;
  while (driven.way_m() < 32.0) known.add(driven.next(), std::nullopt);
  RingRun jumped;
  while (jumped.way_m() < 8.0) carried.add(jumped.next(), std::nullopt);
  jumped.carry(18.0);  // round two corners: nothing of what the submap knows is in sight
  while (jumped.way_m() < 32.0) carried.add(jumped.next(), std::nullopt);
  const auto variance = [](const SubmapChain& chain) {
    double sum = 0.0;
    for (std::size_t i = 1; i < chain.submaps().size(); ++i) sum += chain.link(i).covariance(0, 0);
    return sum;
  };
  CHECK(variance(carried) > 5.0 * variance(known));
}

TEST_CASE("a pose that is no number, none in the map or dead reckoning alone is no key scan") {
  KeyScanChoice choice;
  PoseEstimate good;
  good.mode = PoseMode::kRegistered;
  good.covariance.setIdentity();
  CHECK(choice.wants(good));
  PoseEstimate bad = good;
  bad.T_map_base.translation().x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(choice.wants(bad));
  bad = good;
  bad.mode = PoseMode::kPriorOnly;
  CHECK_FALSE(choice.wants(bad));
  bad = good;
  bad.for_map = false;
  CHECK_FALSE(choice.wants(bad));
}

TEST_CASE(
    "samples of key scans stay as long as the planes of their submap: loops are tested by free space with "
    "them") {
  auto chain = test_submap_chain::chain();
  RingRun run;
  while (run.way_m() < 45.0) chain.add(run.next(), std::nullopt);
  const auto samples = [&](std::size_t number) {
    const auto& keys = chain.submaps()[number].keys;
    return std::count_if(keys.begin(), keys.end(), [](const KeyScan& key) { return !key.p_base.empty(); });
  };
  REQUIRE(chain.complete() >= 2);
  CHECK(samples(1) >= 4);  // of 10 m, one each 2 m
  chain.forget_beyond(0);
  CHECK(samples(1) == 0);
}

TEST_CASE("the oldest submaps are forgotten beyond the memory, and no others") {
  auto chain = test_submap_chain::chain();
  RingRun run;
  while (run.way_m() < 45.0) chain.add(run.next(), std::nullopt);
  REQUIRE(chain.complete() >= 3);
  const std::size_t newest = chain.submaps()[chain.complete() - 1].planes->plane_count();
  chain.forget_beyond(newest);
  for (std::size_t i = 0; i + 1 < chain.complete(); ++i) CHECK(chain.submaps()[i].planes == nullptr);
  CHECK(chain.submaps()[chain.complete() - 1].planes != nullptr);
}

}  // namespace
}  // namespace isobar::test::test_submap_chain
