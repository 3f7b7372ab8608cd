// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/registration/dead_reckoning_error.hpp"
#include "core/registration/map_drift.hpp"

namespace isobar::test::test_map_drift {

namespace {

using Eigen::Vector3d;

const Vector3d kOrigin = Vector3d::Zero();  // {} leaves a vector of Eigen without a value

/// A scan at `p_map` that is known to `m` and `rad` against the map.
LaidScan scan_at(const Vector3d& p_map, double m = 0.005, double rad = 3e-4) {
  LaidScan scan;
  scan.T_map_base.translation() = p_map;
  scan.covariance.diagonal().head<3>().setConstant(m * m);
  scan.covariance.diagonal().tail<3>().setConstant(rad * rad);
  return scan;
}

/// From the last place in `steps` steps to `to`.
void drive(MapDrift& drift, const Vector3d& from, const Vector3d& to, int steps,
           const LaidScan& like = scan_at(kOrigin)) {
  for (int i = 1; i <= steps; ++i) {
    LaidScan scan = like;
    scan.T_map_base.translation() = from + (to - from) * (static_cast<double>(i) / steps);
    drift.lay(scan);
  }
}

double sd(const MapDrift& drift, int row) { return std::sqrt(drift.covariance()(row, row)); }

}  // namespace

TEST_CASE("a robot that stands gains no error, and one that circles in a room gains it once") {
  MapDrift drift;
  drive(drift, kOrigin, {2.0, 0.0, 0.0}, 20);
  const Matrix6d before = drift.covariance();
  for (int i = 0; i < 1000; ++i) drift.lay(scan_at({2.0, 0.0, 0.0}));
  CHECK(drift.covariance() == before);
  for (int i = 0; i < 200; ++i) drive(drift, {2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 5);
  CHECK(sd(drift, 5) < 3.0 * std::sqrt(before(5, 5)));
}

TEST_CASE("on new ground the error does not depend on the length of the steps") {
  MapDrift fine;
  MapDrift coarse;
  // No step ends on the border of a cell, where rounding decides which of the two cells it opens.
  const Vector3d start{0.01, 0.01, 0.01};
  const Vector3d end = start + Vector3d{100.0, 0.0, 0.0};
  drive(fine, start, end, 2000);
  drive(coarse, start, end, 200);
  CHECK((fine.covariance() - coarse.covariance()).norm() < 0.02 * fine.covariance().norm());
}

TEST_CASE("on a straight way yaw makes the error across it, with the variance of an integrated random walk") {
  MapDrift drift;
  drive(drift, kOrigin, {200.0, 0.0, 0.0}, 4000);
  const Matrix6d P = drift.covariance();
  // q s^3 / 3 across the way, q s of the yaw, and the walk of the position on both axes.
  CHECK(P(1, 1) - P(0, 0) == doctest::Approx(P(5, 5) * 200.0 * 200.0 / 3.0).epsilon(0.01));
  CHECK(P(1, 5) > 0.0);
  // A scan that knows yaw to 0.3 mrad, as the gyro knows a step to 1, keeps it over some metres.
  CHECK(sd(drift, 5) > 3e-4 * 0.3 * std::sqrt(200.0) / 3.0);
  CHECK(sd(drift, 5) < 3e-4 * 0.3 * std::sqrt(200.0));
}

TEST_CASE("a direction that the scans hold badly drifts, the others do not") {
  MapDrift drift;
  LaidScan corridor = scan_at(kOrigin);
  corridor.covariance(0, 0) = 0.05 * 0.05;
  drive(drift, kOrigin, {0.0, 40.0, 0.0}, 400, corridor);
  MapDrift seen;
  drive(seen, kOrigin, {0.0, 40.0, 0.0}, 400);
  CHECK(sd(drift, 0) > 2.0 * sd(seen, 0));
  CHECK(sd(drift, 1) == doctest::Approx(sd(seen, 1)));
}

TEST_CASE("a direction that only wheels hold errs by their scale, in proportion to the way") {
  MapDrift drift;
  LaidScan corridor = scan_at(kOrigin, 0.0, 0.0);
  corridor.on_wheels(0, 0) = 1.0;
  drive(drift, kOrigin, {100.0, 100.0, 0.0}, 1000, corridor);
  MapDrift seen;
  drive(seen, kOrigin, {100.0, 100.0, 0.0}, 1000, scan_at(kOrigin, 0.0, 0.0));
  CHECK(sd(drift, 0) > 99.0 * kWheelScaleError);
  CHECK(sd(drift, 0) < 110.0 * kWheelScaleError);
  CHECK(sd(drift, 1) == doctest::Approx(sd(seen, 1)).epsilon(0.02));
}

TEST_CASE("back on known ground the error is that of the first visit, and from there it grows again") {
  MapDrift drift;
  drive(drift, kOrigin, {6.0, 0.0, 0.0}, 60);
  const Matrix6d first = drift.covariance();
  CHECK_FALSE(drift.on_known_ground());
  drive(drift, {6.0, 0.0, 0.0}, {60.0, 0.0, 0.0}, 540);
  drive(drift, {60.0, 0.0, 0.0}, {60.0, 40.0, 0.0}, 400);
  const Matrix6d far = drift.covariance();
  drive(drift, {60.0, 40.0, 0.0}, {0.0, 40.0, 0.0}, 600);
  drive(drift, {0.0, 40.0, 0.0}, {5.0, 0.0, 0.0}, 400);
  for (int i = 0; i < 3; ++i) {
    drive(drift, {5.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 50);
    drive(drift, {0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, 50);
  }
  CHECK(drift.on_known_ground());
  CHECK(far(5, 5) > 5.0 * first(5, 5));
  CHECK(drift.covariance()(5, 5) < 1.2 * first(5, 5));
  CHECK(drift.covariance()(1, 1) < 1.5 * first(1, 1));
  const double home = sd(drift, 5);
  drive(drift, {5.0, 0.0, 0.0}, {5.0, -40.0, 0.0}, 400);
  CHECK_FALSE(drift.on_known_ground());
  CHECK(sd(drift, 5) > 1.5 * home);
}

TEST_CASE("a robot that returns to its start is on known ground, on whichever side of it") {
  for (const double angle : {0.3, 1.9, 3.4, 5.0}) {
    CAPTURE(angle);
    MapDrift drift;
    drive(drift, kOrigin, {0.0, 30.0, 0.0}, 300);
    drive(drift, {0.0, 30.0, 0.0}, {30.0, 30.0, 0.0}, 300);
    const double far = sd(drift, 5);
    drive(drift, {30.0, 30.0, 0.0}, {std::cos(angle), std::sin(angle), 0.0}, 400);
    CHECK(drift.on_known_ground());
    CHECK(sd(drift, 5) < 0.5 * far);
  }
}

TEST_CASE("ground next door to a cell of long ago is known, next door to the last cell it is new") {
  MapDrift drift;
  drive(drift, kOrigin, {60.0, 0.0, 0.0}, 600);
  drive(drift, {60.0, 0.0, 0.0}, {60.0, 5.0, 0.0}, 50);
  CHECK_FALSE(drift.on_known_ground());
  drive(drift, {60.0, 5.0, 0.0}, {30.0, 5.0, 0.0}, 300);
  CHECK(drift.on_known_ground());
  drive(drift, {30.0, 5.0, 0.0}, {30.0, 15.0, 0.0}, 100);
  CHECK_FALSE(drift.on_known_ground());
}

TEST_CASE("on arrival at known ground the error ends over metres, not at once") {
  MapDrift drift;
  drive(drift, kOrigin, {0.0, 40.0, 0.0}, 400);
  drive(drift, {0.0, 40.0, 0.0}, {40.0, 40.0, 0.0}, 400);
  drive(drift, {40.0, 40.0, 0.0}, {40.0, 0.0, 0.0}, 400);
  Vector3d place(40.0, 0.0, 0.0);
  double before = 0.0;
  while (!drift.on_known_ground() && place.x() > 0.0) {
    before = drift.covariance()(5, 5);
    drive(drift, place, place - Vector3d(0.1, 0.0, 0.0), 1);
    place.x() -= 0.1;
  }
  REQUIRE(drift.on_known_ground());
  CHECK(drift.covariance()(5, 5) > 0.9 * before);
  drive(drift, place, place - Vector3d(3.0, 0.0, 0.0), 30);
  CHECK(drift.covariance()(5, 5) < 0.5 * before);
  CHECK(drift.covariance()(5, 5) > 0.2 * before);
  CHECK(drift.left_of_arrival() == doctest::Approx(std::exp(-1.0)).epsilon(0.1));
}

TEST_CASE("an angle that scans hardly hold drifts as if the gyro held it, one that they hold hardly drifts") {
  const auto walk_rad = [](double rad) {
    MapDrift drift;
    drive(drift, kOrigin, {50.0, 0.0, 0.0}, 500, scan_at(kOrigin, 0.0, rad));
    return sd(drift, 5);
  };
  CHECK(walk_rad(6e-4) == doctest::Approx(4.0 * walk_rad(3e-4)).epsilon(0.01));
}

TEST_CASE("another floor above known ground is new ground") {
  MapDrift drift;
  drive(drift, kOrigin, {2.0, 0.0, 0.0}, 20);
  drift.carry({2.0, 0.0, 4.0});
  drive(drift, {2.0, 0.0, 4.0}, {1.0, 0.0, 4.0}, 10);
  CHECK_FALSE(drift.on_known_ground());
}

TEST_CASE("a constant tilt of the scans raises the map ahead in proportion to the way, there and back") {
  MapDrift drift;
  LaidScan tilted = scan_at(kOrigin, 0.0, 0.0);
  tilted.offset_rad = 0.01;
  tilted.levelled = true;
  drive(drift, kOrigin, {40.0, 0.0, 0.0}, 400, tilted);
  CHECK(sd(drift, 2) == doctest::Approx(0.4).epsilon(0.01));
  drive(drift, {40.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 390, tilted);
  CHECK(sd(drift, 2) < 0.05);
}

TEST_CASE("an offset that becomes known is known of the ground behind as well") {
  for (const bool levelled : {true, false}) {
    CAPTURE(levelled);
    MapDrift drift;
    drift.restart(levelled ? 0.0 : 0.01);
    LaidScan tilted = scan_at(kOrigin, 0.0, 0.0);
    tilted.offset_rad = 0.01;
    tilted.levelled = levelled;
    drive(drift, kOrigin, {40.0, 0.0, 0.0}, 400, tilted);
    CHECK(sd(drift, 2) == doctest::Approx(0.4).epsilon(0.01));
    CHECK(sd(drift, 4) == doctest::Approx(levelled ? 0.0 : 0.01));
    tilted.offset_rad = 0.001;
    drive(drift, {40.0, 0.0, 0.0}, {40.1, 0.0, 0.0}, 1, tilted);
    CHECK(sd(drift, 2) < 0.05);
  }
}

TEST_CASE("a tilt of the map is one of the whole map, and as well known as its source says") {
  MapDrift drift;
  drift.restart(0.0, 0.01);
  drive(drift, kOrigin, {0.0, 0.0, 30.0}, 300,
        scan_at(kOrigin, 0.0, 0.0));  // down a shaft: tilt moves it sideways
  CHECK(sd(drift, 0) == doctest::Approx(0.3).epsilon(0.02));
  drift.know_tilt(0.001 * 0.001);
  CHECK(sd(drift, 3) == doctest::Approx(0.001));
  CHECK(std::abs(drift.covariance()(0, 4)) <= sd(drift, 0) * sd(drift, 4) * (1.0 + 1e-9));
}

TEST_CASE("a map whose past is unknown errs with the distance from its origin, across more than along") {
  MapDrift drift;
  drift.restart_at({50.0, 0.0, 0.0});
  CHECK(sd(drift, 1) > 1.5 * sd(drift, 0));
  CHECK(sd(drift, 0) > 0.02);
  const double least = Eigen::SelfAdjointEigenSolver<Matrix6d>(drift.covariance()).eigenvalues().minCoeff();
  CHECK(least > -1e-9);
}

}  // namespace isobar::test::test_map_drift
