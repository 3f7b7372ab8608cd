// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/first_arrival.hpp"

#include <doctest/doctest.h>

#include "tests/core/floors/scene.hpp"

namespace isobar::test::test_first_arrival {

namespace {

constexpr std::int64_t kScanNs = 100'000'000;

/// A robot at 0.8 m/s with a scan each 0.1 s, which has driven one floor at the height 0.
class Drive {
 public:
  explicit Drive(const Scene& scene) {
    ground_.add(scene.points);
    ground_.finish();
    found();
  }

  /// Drives to a place. True if a provisional floor was opened on the way.
  bool to(const Eigen::Vector3d& p_map) { return move(p_map, 0.08); }
  /// Rides without a way in plan, at 1 m/s.
  bool ride_to(double z) { return move({p_map_.x(), p_map_.y(), z}, 0.1); }
  bool stand(int scans) {
    bool opened = false;
    for (int i = 0; i < scans; ++i) opened = step(p_map_) || opened;
    return opened;
  }
  /// The floors are found anew: those driven enough, at these heights.
  void found(const std::vector<double>& heights = {0.0}) {
    floors = Floors();
    for (const double z : heights) {
      Floor& floor = floors.floors.emplace_back();
      floor.number = static_cast<int>(floors.floors.size()) - 1;
      floor.height_m = floor.lowest_m = floor.highest_m = z;
    }
    arrival_.renew(floors);
  }

  Floors floors;

 private:
  bool move(const Eigen::Vector3d& to, double step_m) {
    const Eigen::Vector3d from = p_map_;
    const int steps = static_cast<int>(std::ceil((to - from).norm() / step_m));
    bool opened = false;
    for (int i = 1; i <= steps; ++i) opened = step(from + (to - from) * i / steps) || opened;
    return opened;
  }
  bool step(const Eigen::Vector3d& p_map) {
    p_map_ = p_map;
    arrival_.drive_to(stamp_ns_ += kScanNs, p_map);
    return arrival_.open(ground_, floors);
  }

  GroundColumns ground_;
  FirstArrival arrival_;
  Eigen::Vector3d p_map_ = Eigen::Vector3d::Zero();
  std::int64_t stamp_ns_ = 1;
};

/// Two corridors, 3 m apart in height, and stairs of 30 steps between x = 10 and x = 16; a cabin stands at x = -2.
Scene stairwell() {
  Scene scene;
  scene.add_ground(0.0, -1.5, 10.0, 1.5, 0.0);
  scene.add_ground(16.0, -1.5, 30.0, 1.5, 3.0);
  for (int i = 0; i < 20; ++i) {
    const double x = 10.0 + 0.3 * i;
    scene.add_ground(x, -1.0, x + 0.3, 1.0, 0.15 * (i + 1));
  }
  return scene;
}

}  // namespace

TEST_CASE("a floor is opened within half a metre behind the stairs, once, and not on them") {
  Drive drive(stairwell());
  CHECK_FALSE(drive.to({10.0, 0.0, 0.0}));
  CHECK_FALSE(drive.to({16.0, 0.0, 3.0}));
  CHECK(drive.to({16.7, 0.0, 3.0}));
  REQUIRE(drive.floors.floors.size() == 2);
  const Floor& floor = drive.floors.floors.back();
  CHECK(floor.is_provisional);
  CHECK(floor.number == 1);
  CHECK(floor.height_m == doctest::Approx(3.0).epsilon(0.01));
  const FloorGuess guess = floor_at(drive.floors, {16.7, 0.0, 3.0}, 0.02);
  CHECK(guess.floor == &floor);
  CHECK(guess.place == FloorPlace::kOnFloor);
  CHECK(guess.certainty <= 0.6);
  CHECK_FALSE(drive.to({20.0, 0.0, 3.0}));
}

TEST_CASE("a robot that stands on the stairs, on a landing or in a cabin between two floors opens none") {
  Scene scene = stairwell();
  scene.add_ground(11.0, 5.0, 14.0, 8.0, 2.8);    // a landing of 9 m^2
  scene.add_ground(-3.0, -1.0, -1.0, 1.0, 6.0);   // the cabin
  scene.add_ground(-12.0, -1.0, -3.2, 1.0, 9.0);  // beside its door, 3 m above
  Drive drive(scene);
  drive.to({15.7, 0.0, 2.85});
  CHECK_FALSE(drive.stand(20));
  drive.to({12.0, 6.0, 2.8});
  CHECK_FALSE(drive.stand(20));
  drive.to({-2.0, 0.0, 0.0});
  CHECK_FALSE(drive.ride_to(6.0));
  CHECK_FALSE(drive.stand(20));
  CHECK_FALSE(drive.ride_to(8.5));
}

TEST_CASE("a wide ramp is no floor, whether the robot drives or stands on it") {
  Scene scene;
  scene.add_ground(-10.0, -5.0, 0.0, 5.0, 0.0);
  scene.add({0.0, -5.0, 0.0}, {80.0, 0.0, 4.8}, {0.0, 10.0, 0.0});  // 6 %: 40 m^2 within 0.12 m of a height
  Drive drive(scene);
  CHECK_FALSE(drive.to({70.0, 0.0, 4.2}));
  CHECK_FALSE(drive.stand(20));
}

TEST_CASE(
    "where the storeys are known, a height that is a multiple of them is a floor before its ground is seen") {
  Drive drive(stairwell());
  drive.found({0.0, 3.0});
  drive.ride_to(4.6);
  CHECK_FALSE(drive.stand(20));
  CHECK_FALSE(drive.ride_to(9.1));
  CHECK(drive.stand(6));
  REQUIRE(drive.floors.floors.size() == 3);
  CHECK(drive.floors.floors.back().number == 3);
  CHECK(drive.floors.floors.back().height_m == doctest::Approx(9.1));
}

TEST_CASE("a provisional floor is kept while the robot is on it, until the floors that are found have it") {
  Drive drive(stairwell());
  drive.to({10.0, 0.0, 0.0});
  drive.to({16.0, 0.0, 3.0});
  REQUIRE(drive.to({17.0, 0.0, 3.0}));
  drive.found();
  REQUIRE(drive.floors.floors.size() == 2);
  CHECK(drive.floors.floors.back().is_provisional);
  drive.found({0.0, 3.02});
  REQUIRE(drive.floors.floors.size() == 2);
  CHECK_FALSE(drive.floors.floors.back().is_provisional);
  drive.to({16.0, 0.0, 3.0});
  drive.to({12.0, 0.0, 1.0});
  drive.found({0.0, 3.02});
  CHECK(drive.floors.floors.size() == 2);
}

TEST_CASE("a floor that was left too soon is dropped, and no other provisional one has its number") {
  Scene scene = stairwell();
  scene.add_ground(16.0, 5.0, 30.0, 8.0, 5.8);
  Drive drive(scene);
  drive.to({10.0, 0.0, 0.0});
  drive.to({16.0, 0.0, 3.0});
  REQUIRE(drive.to({17.0, 0.0, 3.0}));
  drive.to({16.0, 0.0, 3.0});
  drive.to({12.0, 0.0, 1.0});
  drive.found();
  CHECK(drive.floors.floors.size() == 1);
  CHECK_FALSE(drive.to({17.0, 6.5, 5.8}));
  CHECK_FALSE(drive.stand(20));  // it would be 1
  drive.to({16.0, 0.0, 3.0});
  CHECK(drive.stand(20));  // the same floor again
  CHECK(drive.floors.floors.back().number == 1);
}

}  // namespace isobar::test::test_first_arrival
