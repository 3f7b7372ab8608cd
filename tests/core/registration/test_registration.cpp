// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/registration/registration.hpp"
#include "tests/core/registration/synthetic_world.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_registration {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kScanNs = 100'000'000;
constexpr double kNoiseM = 0.015;
constexpr double kSensorHeightM = 0.7;

double seconds_of(std::int64_t stamp_ns) { return static_cast<double>(stamp_ns - kStart) * 1e-9; }

Eigen::Isometry3d lidar_mount() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 0.1, 0.0, 0.3;
  return T;
}

// Drives a circle of 1.5 m radius in the middle of the room, standing still for the first second; rocks a
// little, as tracks do. Starts at yaw 0.
Eigen::Isometry3d circle(std::int64_t stamp_ns) {
  const double t = std::max(0.0, seconds_of(stamp_ns) - 1.0);
  const double angle = 0.4 * t;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.02 * std::sin(2.0 * t), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(0.02 * std::sin(3.1 * t), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() << 1.5 * std::sin(angle), -1.5 * std::cos(angle), kSensorHeightM;
  return T;
}

Eigen::Isometry3d along_x(std::int64_t stamp_ns) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 0.8 * std::max(0.0, seconds_of(stamp_ns) - 1.0), 0.0, kSensorHeightM;
  return T;
}

using MakePrior = std::function<Prior(std::int64_t stamp_ns)>;

// Dead reckoning with 4 % of scale error and 0.3 degrees of yaw drift a second; heights from the start.
MakePrior drifting(const Motion& motion) {
  return [motion](std::int64_t stamp_ns) {
    Prior prior = perfect_prior(motion, stamp_ns);
    const double drift = 0.005 * seconds_of(stamp_ns);
    prior.T_odom_base.linear() =
        Eigen::AngleAxisd(drift, Eigen::Vector3d::UnitZ()) * prior.T_odom_base.linear();
    prior.T_odom_base.translation().head<2>() *= 1.04;
    prior.height_m -= kSensorHeightM;
    return prior;
  };
}

MakePrior without_wheels(const MakePrior& make) {
  return [make](std::int64_t stamp_ns) {
    Prior prior = make(stamp_ns);
    prior.T_odom_base.translation().setZero();
    prior.velocity_valid = false;
    return prior;
  };
}

// The stages of a run, in lock step.
class Run {
 public:
  Run(const World& world, Motion motion, MakePrior make_prior, Method method)
      : world_(world),
        motion_(std::move(motion)),
        make_prior_(std::move(make_prior)),
        registration_(RegistrationConfig{}, method, lidar_mount()),
        map_(MapConfig{}, lidar_mount()) {
    registration_.add_prior(make_prior_(kStart));
  }

  // Priors up to the end of scan `index`, the scan unless it is lost, the map.
  const PoseEstimate& step(bool scan_arrives = true) {
    const std::int64_t begin = kStart + index_++ * kScanNs;
    for (std::int64_t t = begin + 5'000'000; t <= begin + kScanNs + 5'000'000; t += 5'000'000) {
      registration_.add_prior(make_prior_(t));
    }
    if (scan_arrives) {
      scan_world(world_, motion_, lidar_mount(), begin, kNoiseM, random_, *scan_);
      register_scan();
    }
    return out_->pose;
  }

  const PoseEstimate& register_scan() {
    const std::size_t before = allocation_count();
    registration_.register_scan(*scan_, *map_.snapshot(), *out_);
    allocations_ += allocation_count() - before;
    map_.update(*out_);
    return out_->pose;
  }

  // Error of the newest pose, in the frame of the first pose's yaw and place.
  [[nodiscard]] Eigen::Vector3d position_error() const {
    Eigen::Isometry3d T_world_map = Eigen::Isometry3d::Identity();
    T_world_map.translation() = motion_(kStart).translation();
    return T_world_map * out_->pose.T_map_base.translation() - motion_(out_->pose.stamp_ns).translation();
  }
  [[nodiscard]] double rotation_error_deg() const {
    return Eigen::AngleAxisd(out_->pose.T_map_base.linear() *
                             motion_(out_->pose.stamp_ns).linear().transpose())
               .angle() *
           180.0 / 3.14159265358979;
  }

  [[nodiscard]] const PoseEstimate& pose() const { return out_->pose; }
  Registration& registration() { return registration_; }
  Scan& scan() { return *scan_; }
  void enter(const World& world) { world_ = world; }
  [[nodiscard]] std::size_t allocations() const { return allocations_; }

 private:
  World world_;
  Motion motion_;
  MakePrior make_prior_;
  Registration registration_;
  LocalMap map_;
  std::mt19937 random_{42};
  std::int64_t index_ = 0;
  std::unique_ptr<Scan> scan_ = std::make_unique<Scan>();
  std::unique_ptr<RegisteredScan> out_ = std::make_unique<RegisteredScan>();
  std::size_t allocations_ = 0;
};

}  // namespace

TEST_CASE("3-, 4- and 6-DOF follow a drive around a room that dead reckoning loses by 20 cm") {
  for (const Method method : {Method::k3Dof, Method::k4Dof, Method::k6Dof}) {
    CAPTURE(static_cast<int>(method));
    Run run(furnished_room(), circle, drifting(circle), method);
    int registered = 0;
    for (int i = 0; i < 80; ++i) {
      registered += run.step().mode == PoseMode::kRegistered ? 1 : 0;
    }
    CHECK(registered >= 78);
    // Noise of 1.5 cm a point averages out; what is left is the drift of a map that grows on its own errors.
    CHECK(run.position_error().norm() < 0.02);
    CHECK(run.rotation_error_deg() < 0.3);
    CHECK(run.pose().effective_method == method);
    CHECK(run.pose().overlap > 0.8);
    CHECK_FALSE(run.pose().degenerate);
    // 8 s of 0.3 deg/s and 4 % of 1.5 m: the prior alone is off by more than ten times that.
    const Eigen::Isometry3d odom = drifting(circle)(run.pose().stamp_ns).T_odom_base;
    CHECK((odom.translation() - circle(run.pose().stamp_ns).translation()).norm() > 0.05);
  }
}

TEST_CASE("the map starts at x = y = yaw = 0 and the altimeter's height, whatever odom says") {
  const Motion tilted = [](std::int64_t stamp_ns) {
    Eigen::Isometry3d T = circle(stamp_ns);
    T.linear() = T.linear() * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
    return T;
  };
  const MakePrior elsewhere = [&](std::int64_t stamp_ns) {
    Prior prior = drifting(tilted)(stamp_ns);
    prior.T_odom_base = Eigen::Translation3d(7.0, 8.0, 9.0) *
                        Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) * prior.T_odom_base;
    prior.height_m = 0.25;
    return prior;
  };
  Run run(furnished_room(), tilted, elsewhere, Method::k3Dof);
  const Eigen::Isometry3d T = run.step().T_map_base;
  CHECK(T.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 0.25), 1e-9));
  CHECK(std::atan2(T.linear()(1, 0), T.linear()(0, 0)) == doctest::Approx(0.0).epsilon(1e-9));
  CHECK(std::asin(-T.linear()(2, 0)) == doctest::Approx(0.1).epsilon(1e-6));
  // T_map_base = T_map_odom * T_odom_base.
  const Eigen::Isometry3d odom = elsewhere(run.pose().stamp_ns).T_odom_base;
  CHECK((run.pose().T_map_odom * odom).isApprox(T, 1e-9));
}

TEST_CASE("3-DOF takes height from pressure to the last bit, and roll and pitch from gravity") {
  Run run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 20; ++i) {
    run.step();
    const Prior prior = drifting(circle)(run.pose().stamp_ns);
    CHECK(run.pose().T_map_base.translation().z() == doctest::Approx(prior.height_m).epsilon(1e-12));
    const Eigen::Vector3d up = run.pose().T_map_base.linear().row(2);
    CHECK((up - prior.T_odom_base.linear().row(2).transpose()).norm() < 1e-9);
  }
}

TEST_CASE("wheels bridge a corridor that has no features, the walls hold the rest, and it is said") {
  Run run(bare_corridor(), along_x, drifting(along_x), Method::k3Dof);
  for (int i = 0; i < 80; ++i) {
    run.step();
  }
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.pose().degenerate);
  // 5.6 m with 4 % of scale error are 0.22 m; nothing but the wheels knows, so the same comes out.
  CHECK(run.position_error().x() == doctest::Approx(0.224).epsilon(0.25));
  CHECK(std::abs(run.position_error().y()) < 0.02);
  CHECK(run.rotation_error_deg() < 0.3);
  // Its covariance says so as well: far along, little across.
  CHECK(run.pose().covariance(0, 0) > 4.0 * run.pose().covariance(1, 1));
}

TEST_CASE("without any barometer 3-DOF runs as 4-DOF, says so, and still keeps the height") {
  const MakePrior blind = [](std::int64_t stamp_ns) {
    Prior prior = drifting(circle)(stamp_ns);
    prior.height_m = 77.0;
    prior.height_source = HeightSource::kNone;
    return prior;
  };
  Run run(furnished_room(), circle, blind, Method::k3Dof);
  for (int i = 0; i < 40; ++i) {
    run.step();
  }
  CHECK(run.pose().method == Method::k3Dof);
  CHECK(run.pose().effective_method == Method::k4Dof);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE("without wheels the registrations' own velocity is enough") {
  for (const Method method : {Method::k3Dof, Method::k6Dof}) {
    Run run(furnished_room(), circle, without_wheels(drifting(circle)), method);
    for (int i = 0; i < 80; ++i) {
      run.step();
    }
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.position_error().norm() < 0.03);
  }
}

TEST_CASE("five seconds without lidar: the prior goes on, and the next scans find the map again") {
  Run run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 30; ++i) {
    run.step();
  }
  for (int i = 0; i < 50; ++i) {
    run.step(false);
    PoseEstimate between;
    REQUIRE(run.registration().propagate(between));
    CHECK(between.mode == PoseMode::kPriorOnly);
  }
  PoseEstimate bridged;
  REQUIRE(run.registration().propagate(bridged));
  const Eigen::Vector3d truth = circle(bridged.stamp_ns).translation() - circle(kStart).translation();
  // 3 m of way with 4 % and 1.5 degrees of drift.
  CHECK((bridged.T_map_base.translation() - truth).norm() < 0.3);
  CHECK(bridged.covariance(0, 0) > run.pose().covariance(0, 0));
  for (int i = 0; i < 5; ++i) {
    run.step();
  }
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.03);
}

TEST_CASE("a scan of another place is not believed: the prior stands, and what follows is not harmed") {
  Run run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 20; ++i) {
    run.step();
  }
  World elsewhere;
  elsewhere.add_box({-30.0, -25.0, -10.0}, {27.0, 33.0, 14.0});
  run.enter(elsewhere);
  run.step();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  CHECK(run.position_error().norm() < 0.03);
  run.enter(furnished_room());
  for (int i = 0; i < 3; ++i) {
    run.step();
  }
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE("a place where the map knows nothing is entered with the prior and becomes map") {
  Run run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 20; ++i) {
    run.step();
  }
  World hall;
  hall.add_box({-30.0, -25.0, 0.0}, {27.0, 33.0, 8.0});
  run.enter(hall);
  int registered = 0;
  for (int i = 0; i < 30; ++i) {
    registered += run.step().mode == PoseMode::kRegistered ? 1 : 0;
  }
  CHECK(registered > 20);
  CHECK(run.position_error().norm() < 0.15);
}

TEST_CASE("empty scans, scans out of order, and priors that come late end in the prior's pose") {
  Run run(furnished_room(), circle, drifting(circle), Method::k3Dof);
  for (int i = 0; i < 10; ++i) {
    run.step();
  }
  run.scan().point_count = 0;
  run.register_scan();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  CHECK(run.pose().T_map_base.matrix().allFinite());
  run.scan().stamp_ns -= 3 * kScanNs;
  run.scan().end_stamp_ns -= 3 * kScanNs;
  run.register_scan();
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  for (int i = 0; i < 5; ++i) {
    run.step();
  }
  CHECK(run.pose().mode == PoseMode::kRegistered);
  CHECK(run.position_error().norm() < 0.02);
}

TEST_CASE("before any prior there is no pose, and nothing to propagate") {
  Registration registration(RegistrationConfig{}, Method::k3Dof, lidar_mount());
  auto scan = std::make_unique<Scan>();
  std::mt19937 random(1);
  scan_world(furnished_room(), circle, lidar_mount(), kStart, 0.0, random, *scan);
  CHECK_FALSE(registration.ready(*scan));
  auto out = std::make_unique<RegisteredScan>();
  registration.register_scan(*scan, MapSnapshot(), *out);
  CHECK(out->pose.mode == PoseMode::kInitializing);
  CHECK(out->point_count == 0);
  PoseEstimate pose;
  CHECK_FALSE(registration.propagate(pose));
}

TEST_CASE("dead reckoning as a method ignores the scan") {
  Run run(furnished_room(), circle, drifting(circle), Method::kOdometry);
  for (int i = 0; i < 40; ++i) {
    run.step();
  }
  CHECK(run.pose().mode == PoseMode::kPriorOnly);
  const Eigen::Isometry3d first = drifting(circle)(kStart + kScanNs).T_odom_base;
  const Eigen::Isometry3d now = drifting(circle)(run.pose().stamp_ns).T_odom_base;
  const Eigen::Vector3d expected =
      Eigen::AngleAxisd(-0.0005, Eigen::Vector3d::UnitZ()) * (now.translation() - first.translation());
  CHECK((run.pose().T_map_base.translation() - expected).head<2>().norm() < 1e-6);
}

TEST_CASE("registering a scan allocates nothing") {
  for (const Method method : {Method::k3Dof, Method::k6Dof}) {
    Run run(furnished_room(), circle, drifting(circle), method);
    for (int i = 0; i < 10; ++i) {
      run.step();
    }
    CHECK(run.pose().mode == PoseMode::kRegistered);
    CHECK(run.allocations() == 0);
  }
  CHECK(allocation_count() > 0);  // the counter counts
}

}  // namespace isobar::test::test_registration
