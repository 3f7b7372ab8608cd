// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <vector>

#include "core/place/ray_dispute.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_ray_dispute {
namespace {

// A corridor of 30 m x 3 m, and where it looks the same when it is turned.
const Eigen::Isometry3d kThere = level_pose_at(15.5, 1.4, 0.0, 20.0);
const Eigen::Isometry3d kTurned = level_pose_at(14.5, 1.6, 0.0, -160.0);
constexpr unsigned kLowX = 1;
constexpr unsigned kHighX = 2;

Building corridor(unsigned open_faces = 0) {
  Building building;
  building.add_room({0.0, 0.0, 0.0}, {30.0, 3.0, 2.8}, open_faces);
  return building;
}

/// A metre narrower over the last 6 m.
Building narrow_corridor() {
  Building building;
  building.add_room({0.0, 0.0, 0.0}, {24.0, 3.0, 2.8}, kHighX);
  building.add_room({24.0, 1.0, 0.0}, {30.0, 3.0, 2.8}, kLowX);
  building.add_obstacle({24.0, 0.0, 0.0}, {24.2, 1.0, 2.8});
  return building;
}

RayDispute compare(const Building& in_map, const Building& world) {
  // Four scans whose rays lie between each other's.
  PlaceQuery query;
  for (const double turned_deg : {0.0, 0.25, 0.5, 0.75}) {
    const Eigen::Isometry3d T_level_turned = level_pose_at(0.0, 0.0, 0.0, turned_deg);
    std::vector<Eigen::Vector3f> p_level = world.seen_from(kThere * T_level_turned);
    for (Eigen::Vector3f& p : p_level) p = T_level_turned.cast<float>() * p;
    query.add(p_level, Eigen::Vector3f(0.0F, 0.0F, 0.6F));
  }
  query.finish();
  const KnownMap map = in_map.map();
  const RayDispute result = dispute(*map.snapshot(), query, kThere, kTurned);
  const RayDispute swapped = dispute(*map.snapshot(), query, kTurned, kThere);
  CHECK(result.one.explained == swapped.other.explained);
  CHECK((result.winner() == RayDispute::Winner::kOne) == (swapped.winner() == RayDispute::Winner::kOther));
  CHECK((result.winner() == RayDispute::Winner::kOther) == (swapped.winner() == RayDispute::Winner::kOne));
  return result;
}

}  // namespace

TEST_CASE("a corridor that looks the same when turned leaves no dispute") {
  const RayDispute result = compare(corridor(), corridor());
  CHECK(result.one.explained == 0);
  CHECK(result.other.explained == 0);
  CHECK(result.winner() == RayDispute::Winner::kNone);
}

TEST_CASE("rays that pass through a wall of the map refute a pose") {
  const RayDispute result = compare(narrow_corridor(), narrow_corridor());
  CHECK(result.winner() == RayDispute::Winner::kOne);
  CHECK(result.other.blocked_groups == 0);
}

TEST_CASE("what the map has not seen refutes no pose") {
  const RayDispute result = compare(corridor(kHighX), corridor());
  CHECK(result.other.explained > 20);
  CHECK(result.winner() == RayDispute::Winner::kNone);
}

TEST_CASE("a cabinet that has gone since refutes no pose") {
  // In the map there are its front and its side, and nothing behind them.
  Building before;
  before.add_room({0.0, 0.0, 0.0}, {18.0, 3.0, 2.8}, kHighX);
  before.add_room({18.0, 0.0, 0.0}, {20.6, 2.5, 2.8}, kLowX | kHighX);
  before.add_room({20.6, 0.0, 0.0}, {30.0, 3.0, 2.8}, kLowX);
  before.add_obstacle({18.0, 2.5, 0.0}, {18.1, 3.0, 2.8});
  const RayDispute result = compare(before, corridor());
  CHECK(result.other.blocked_groups >= 8);
  CHECK(result.winner() == RayDispute::Winner::kNone);
}

}  // namespace isobar::test::test_ray_dispute
