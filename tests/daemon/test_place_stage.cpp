// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "daemon/place_stage.hpp"
#include "tests/core/place/building.hpp"

namespace isobar::test::test_place_stage {
namespace {

constexpr double kScanS = 0.1;
constexpr double kUnknownM2 = 100.0;

/// A room that a wall divides: what is behind it, is seen only past its end.
void add_divided_room(Building& building, double x_m, double cabinet_m) {
  building.add_room({x_m, 0.0, 0.0}, {x_m + 6.0, 9.0, 3.0});
  building.add_obstacle({x_m, 4.4, 0.0}, {x_m + 4.6, 4.6, 3.0});
  building.add_obstacle({x_m + 1.0, 3.0, 0.0}, {x_m + 1.8, 4.4, 1.9});
  building.add_obstacle({x_m + cabinet_m, 7.0, 0.0}, {x_m + cabinet_m + 1.2, 8.2, 2.0});
}

Building two_rooms() {
  Building building;
  add_divided_room(building, 0.0, 0.8);
  add_divided_room(building, 10.0, 2.6);
  return building;
}

/// A robot in a building, with a stage that has a map.
class Robot {
 public:
  Robot(const Building& in_map, const Building& world, bool stays = false) : world_(world) {
    auto map = std::make_shared<const KnownMap>(in_map.map());
    StageSettings settings;
    settings.T_base_lidar.translation().z() = 0.6;
    stage_ = std::make_unique<PlaceStage>(settings, [this, map](std::uint32_t /*session*/) {
      ++reads_;
      return map;
    });
    RunStart start;
    KnownPlace place;
    place.anywhere = true;
    place.has_height = true;
    place.height_m = 2.0;  // of the prior, at z = 0
    start.place = place;
    stage_->begin_at(start, stays);
    scan_->pose.covariance(0, 0) = kUnknownM2;
  }

  /// One scan at a place, a tenth of a second later.
  PlaceOrder scan_at(const Eigen::Isometry3d& T_map_base) {
    stamp_ns_ += static_cast<std::int64_t>(kScanS * 1e9);
    if (points_.empty() || !T_map_base.isApprox(T_seen_)) points_ = world_.seen_from(T_map_base);
    T_seen_ = T_map_base;
    const std::vector<Eigen::Vector3f>& points = points_;
    scan_->point_count = sees_ ? static_cast<std::uint32_t>(points.size()) : 0;
    for (std::size_t i = 0; i < scan_->point_count; ++i) {
      scan_->points[i].x_m = points[i].x();
      scan_->points[i].y_m = points[i].y();
      scan_->points[i].z_m = points[i].z();
    }
    PoseEstimate& pose = scan_->pose;
    pose.stamp_ns = stamp_ns_;
    // Neither odometry nor the last pose says where in the map that is.
    const Eigen::Isometry3d T_odom_base = level_pose_at(31.0, -7.0, 5.0, 77.0) * T_map_base;
    pose.T_map_odom = level_pose_at(-3.0, 2.0, 0.5, -30.0);
    pose.T_map_base = pose.T_map_odom * T_odom_base;
    if (believed_) {
      pose.T_map_base = *believed_;
      pose.T_map_odom = pose.T_map_base * T_odom_base.inverse(Eigen::Isometry);
    }
    Prior prior;
    prior.stamp_ns = stamp_ns_;
    prior.height_source = height_source_;
    prior.height_m = 2.0 + T_map_base.translation().z();
    prior.height_variance_m2 = 0.01;
    prior.velocity_valid = true;
    prior.v_base_m_s.x() = stands_ ? 0.0 : 0.5;
    stage_->add_prior(prior);
    last_ = stage_->add_scan(*scan_);
    return last_;
  }
  /// Scans at one place until the stage asks for something.
  PlaceOrder stand_at(const Eigen::Isometry3d& T_map_base, double seconds) {
    for (double s = 0.0; s < seconds; s += kScanS) {
      const PlaceOrder order = scan_at(T_map_base);
      if (order.T_map_odom || order.give_up) return order;
    }
    return {};
  }

  [[nodiscard]] const PlaceStatus& status() const { return stage_->status(); }
  [[nodiscard]] const PoseEstimate& pose() const { return scan_->pose; }
  void know_place() { scan_->pose.mode = PoseMode::kRegistered; }
  /// Where a robot believes to be that knows its place, and how much of its scans matches there.
  void believe(const Eigen::Isometry3d& T_map_base, double overlap) {
    believed_ = T_map_base;
    scan_->pose.overlap = overlap;
    scan_->pose.sampled_points = 1000;
  }
  void stand_on_wheels(bool stands) { stands_ = stands; }
  void see(bool sees) { sees_ = sees; }
  void lose_base_station() { height_source_ = HeightSource::kSingleBarometer; }
  [[nodiscard]] int reads() const { return reads_; }

 private:
  const Building& world_;
  Eigen::Isometry3d T_seen_ = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3f> points_;  // seen there: casting rays takes most of the time of these tests
  std::unique_ptr<PlaceStage> stage_;
  std::unique_ptr<RegisteredScan> scan_ = std::make_unique<RegisteredScan>();
  std::int64_t stamp_ns_ = 1'000'000'000;
  HeightSource height_source_ = HeightSource::kDifferential;
  bool sees_ = true;
  bool stands_ = false;
  std::optional<Eigen::Isometry3d> believed_;
  int reads_ = 0;
  PlaceOrder last_;
};

void check_hint(const PlaceHint& hint, const Eigen::Isometry3d& T) {
  CHECK((hint.p_map_m - T.translation().head<2>()).norm() < 0.1);
  CHECK(std::abs(hint.z_m - T.translation().z()) < 0.1);
  CHECK(std::abs(std::remainder(hint.yaw_rad - yaw_of(T.linear()), 2.0 * kPi)) < 1.0 * kRadPerDeg);
  CHECK(hint.z_is_sure);
}

}  // namespace

TEST_CASE("a robot that begins anywhere in the map is found by its first scans") {
  const Building building = office();
  const Eigen::Isometry3d T = level_pose_at(14.3, 0.6, 0.0, -75.0);
  Robot robot(building, building);
  const PlaceOrder order = robot.stand_at(T, 0.5);
  REQUIRE(order.T_map_odom.has_value());
  check_hint(order.hint_at(robot.pose()), T);
  CHECK(robot.status().state == PlaceState::kTold);
  CHECK(robot.status().height_is_known);
}

TEST_CASE("a hint is where the robot is by then, not where it was seen") {
  const Building building = office();
  Robot robot(building, building);
  const PlaceOrder order = robot.stand_at(level_pose_at(14.3, 0.6, 0.0, -75.0), 0.5);
  REQUIRE(order.T_map_odom.has_value());
  const Eigen::Isometry3d T_later = level_pose_at(15.0, 0.2, 0.0, -50.0);
  robot.scan_at(T_later);
  check_hint(order.hint_at(robot.pose()), T_later);
}

TEST_CASE("a robot that knows its place reads no map") {
  const Building building = office();
  Robot robot(building, building);
  robot.know_place();
  CHECK_FALSE(robot.stand_at(level_pose_at(1.1, -0.7, 0.0, 40.0), 1.0).T_map_odom.has_value());
  CHECK(robot.reads() == 0);
  CHECK(robot.status().state == PlaceState::kIdle);
}

TEST_CASE("places that look alike give no hint before driving tells them apart") {
  const Building building = two_rooms();
  Robot robot(building, building);
  const Eigen::Isometry3d T_first = level_pose_at(11.0, 1.5, 0.0, 30.0);
  CHECK_FALSE(robot.stand_at(T_first, 20.0).T_map_odom.has_value());
  CHECK(robot.status().state == PlaceState::kAmbiguous);
  CHECK(robot.status().hypothesis_count == 2);
  CHECK(robot.status().searches == 1);
  CHECK(place_text(robot.status()).starts_with("2 places of the map fit"));
  const Eigen::Isometry3d T_second = level_pose_at(15.2, 4.6, 0.0, 100.0);
  const PlaceOrder order = robot.stand_at(T_second, 1.0);
  REQUIRE(order.T_map_odom.has_value());
  check_hint(order.hint_at(robot.pose()), T_second);
}

TEST_CASE("an ambiguous place is given up after a bounded time, but not in a stored map") {
  const Building building = two_rooms();
  const Eigen::Isometry3d T = level_pose_at(11.0, 1.5, 0.0, 30.0);
  Robot robot(building, building);
  CHECK(robot.stand_at(T, 125.0).give_up);
  Robot staying(building, building, true);
  CHECK_FALSE(staying.stand_at(T, 125.0).give_up);
  CHECK(staying.status().state == PlaceState::kAmbiguous);
}

TEST_CASE("a robot in another building is said to be nowhere, and given up after a second look") {
  Building elsewhere;  // a corridor, which is longer than the rooms of the map
  elsewhere.add_room({0.0, 0.0, 0.0}, {25.0, 2.2, 3.0});
  const Eigen::Isometry3d T = level_pose_at(12.0, 1.0, 0.0, 30.0);
  Robot robot(office(), elsewhere);
  for (int i = 0; i < 20; ++i) CHECK_FALSE(robot.scan_at(T).give_up);
  CHECK(robot.status().state == PlaceState::kUnknown);
  CHECK(robot.stand_at(T, 5.0).give_up);
  CHECK(robot.status().found == 0);
  CHECK(robot.reads() == 1);

  Robot staying(office(), elsewhere, true);
  CHECK_FALSE(staying.stand_at(T, 20.0).give_up);
  CHECK(staying.status().state == PlaceState::kUnknown);
}

TEST_CASE("a robot that sees nothing is given up after half a minute") {
  const Building building = office();
  Robot robot(building, building);
  robot.see(false);
  CHECK_FALSE(robot.stand_at(level_pose_at(1.1, -0.7, 0.0, 40.0), 29.0).give_up);
  CHECK(robot.stand_at(level_pose_at(1.1, -0.7, 0.0, 40.0), 3.0).give_up);
}

TEST_CASE("a place that the registration does not confirm is refused, and searched again") {
  const Building building = office();
  const Eigen::Isometry3d T = level_pose_at(14.3, 0.6, 0.0, -75.0);
  Robot robot(building, building, true);
  REQUIRE(robot.stand_at(T, 0.5).T_map_odom.has_value());
  CHECK_FALSE(robot.stand_at(T, 3.5).T_map_odom.has_value());
  CHECK(robot.status().refused == 0);
  CHECK(robot.stand_at(T, 5.0).T_map_odom.has_value());
  CHECK(robot.status().refused == 1);
}

TEST_CASE("without a base station all floors are searched, and those that look alike stay in doubt") {
  Building tower = office();
  tower.add_room({-5.0, -4.0, 4.0}, {5.0, 4.0, 7.0});
  tower.add_obstacle({2.0, 2.0, 4.0}, {3.0, 3.2, 5.8});
  tower.add_obstacle({-4.2, -3.0, 4.0}, {-3.0, -1.8, 5.2});
  tower.add_obstacle({3.5, -2.5, 4.0}, {4.0, -1.5, 6.2});
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 4.0, 40.0);
  Robot robot(tower, tower);
  const PlaceOrder known = robot.stand_at(T, 0.5);
  REQUIRE(known.T_map_odom.has_value());
  check_hint(known.hint_at(robot.pose()), T);

  Robot alone(tower, tower);
  alone.lose_base_station();
  CHECK_FALSE(alone.stand_at(T, 2.0).T_map_odom.has_value());
  CHECK_FALSE(alone.status().height_is_known);
  CHECK(alone.status().state == PlaceState::kAmbiguous);
  CHECK(place_text(alone.status()).ends_with("all floors are searched"));
}

TEST_CASE("a robot that stands and at once sees another place is found there, after a second look") {
  const Building building = office();
  const Eigen::Isometry3d T_before = level_pose_at(1.1, -0.7, 0.0, 40.0);
  const Eigen::Isometry3d T_after = level_pose_at(14.3, 0.6, 0.0, -75.0);
  Robot robot(building, building);
  robot.know_place();
  robot.stand_on_wheels(true);
  robot.believe(T_before, 0.9);
  CHECK_FALSE(robot.stand_at(T_before, 3.0).T_map_odom.has_value());
  CHECK(robot.reads() == 0);
  robot.believe(T_before, 0.3);
  robot.stand_at(T_after, 0.1);
  robot.believe(T_before, 0.8);  // its own scans are in the map since
  CHECK_FALSE(robot.stand_at(T_after, 5.0).T_map_odom.has_value());
  CHECK(robot.status().carried);
  CHECK(robot.reads() == 1);
  const Eigen::Isometry3d T_on = T_after * level_pose_at(1.2, 0.0, 0.0, 0.0);
  robot.believe(T_before * level_pose_at(1.2, 0.0, 0.0, 0.0), 0.8);
  const PlaceOrder order = robot.stand_at(T_on, 2.0);
  REQUIRE(order.T_map_odom.has_value());
  check_hint(order.hint_at(robot.pose()), T_on);
}

TEST_CASE("a robot that drives, or before which a door opens, is not taken to be carried away") {
  const Building building = office();
  const Eigen::Isometry3d T = level_pose_at(1.1, -0.7, 0.0, 40.0);
  for (const bool stands : {false, true}) {
    CAPTURE(stands);
    Robot robot(building, building);
    robot.know_place();
    robot.stand_on_wheels(stands);
    robot.believe(T, 0.9);
    robot.stand_at(T, 3.0);
    robot.believe(T, 0.3);
    CHECK_FALSE(robot.stand_at(T, 0.1).T_map_odom.has_value());
    CHECK(robot.status().carried == stands);
    robot.believe(T, 0.8);
    CHECK_FALSE(robot.stand_at(T, 2.0).T_map_odom.has_value());
    CHECK_FALSE(robot.status().carried);
    CHECK(robot.status().searches == (stands ? 1 : 0));
  }
}

}  // namespace isobar::test::test_place_stage
