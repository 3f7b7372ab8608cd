// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/errors.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test::test_trajectory {

using namespace isobar::evaluation;
using namespace isobar::test;
using isobar::DataError;

namespace {

std::string message_of(const std::string& text) {
  try {
    parse_tum(text, "file.tum");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("nine decimals of a TUM stamp give exact nanoseconds, beyond the resolution of a double") {
  const Trajectory t = parse_tum("1700000000.123456789 1 2 3 0 0 0 1\n1700000000.2 1 2 3 0 0 0 1\n", "a");
  REQUIRE(t.poses.size() == 2);
  CHECK(t.poses[0].stamp_ns == 1'700'000'000'123'456'789);
  CHECK(t.poses[1].stamp_ns == 1'700'000'000'200'000'000);
  CHECK(parse_tum("-1.5 0 0 0 0 0 0 1", "a").poses[0].stamp_ns == -1'500'000'000);
  CHECK(parse_tum("7 0 0 0 0 0 0 1", "a").poses[0].stamp_ns == 7'000'000'000);
  CHECK(parse_tum("1.5e2 0 0 0 0 0 0 1", "a").poses[0].stamp_ns == 150'000'000'000);
}

TEST_CASE("a TUM line is position and quaternion x y z w; comments, CRLF and blank lines are accepted") {
  const Trajectory t = parse_tum("# a comment\r\n\r\n  1.0\t4 5 6 0 0 0.6 0.8\r\n", "a");
  REQUIRE(t.poses.size() == 1);
  CHECK(t.poses[0].position_m == Eigen::Vector3d(4, 5, 6));
  CHECK(t.poses[0].attitude.isApprox(Eigen::Quaterniond(0.8, 0, 0, 0.6)));
}

TEST_CASE("poses out of order are sorted, the first of equal stamps is kept, and both are counted") {
  const Trajectory t = parse_tum("3 3 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n2 9 0 0 0 0 0 1\n", "a");
  REQUIRE(t.poses.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(t.poses[static_cast<std::size_t>(i)].position_m.x() == i + 1);
  CHECK(t.repairs.backwards == 1);
  CHECK(t.repairs.duplicates == 1);
}

TEST_CASE("a broken TUM file is refused with file, line and rule") {
  CHECK(message_of("") == "file.tum: has no pose");
  CHECK(message_of("# only words\n") == "file.tum: has no pose");
  CHECK(message_of("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n") ==
        "file.tum:2: a pose has eight numbers: t x y z qx qy qz qw");
  CHECK(message_of("1 0 0 0 0 0 0 1 5\n") == "file.tum:1: more than the eight numbers t x y z qx qy qz qw");
  CHECK(message_of("1 0 nan 0 0 0 0 1\n") == "file.tum:1: 'nan' is not a finite number");
  CHECK(message_of("1 0 0 1e999 0 0 0 1\n") == "file.tum:1: '1e999' is not a finite number");
  CHECK(message_of("x 0 0 0 0 0 0 1\n") == "file.tum:1: the time 'x' is not a number of seconds");
  CHECK(message_of("1e30 0 0 0 0 0 0 1\n") == "file.tum:1: the time '1e30' is not a number of seconds");
  CHECK(message_of("1 0 0 0 0 0 0 0\n") == "file.tum:1: qx qy qz qw is not a unit quaternion");
}

TEST_CASE("a last line that is cut at any byte is left out and told; a cut line elsewhere is an error") {
  const std::string good = "# t x y z\n1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n";
  const std::string last = "3.100000000 1.5 0.25 -0.125 0 0 0 1";
  for (std::size_t length = 0; length <= last.size(); ++length) {
    CAPTURE(length);
    const Trajectory t = parse_tum(good + last.substr(0, length), "f");
    // Complete, though without a line end: as other programs write the last line.
    const bool complete = length == last.size();
    CHECK(t.poses.size() == (complete ? 3 : 2));
    CHECK(t.repairs.cut_line == (complete || length == 0 ? 0 : 4));
  }
  CHECK(parse_tum(good + std::string(500, '\0'), "f").repairs.cut_line == 4);
  CHECK_THROWS_AS(parse_tum("1 0 0 0 0 0 0 1\n2 1 0\n3 1 0 0 0 0 0 1\n", "f"), DataError);
  CHECK_THROWS_AS(parse_tum("1 0 0", "f"), DataError);
}

TEST_CASE("the travelled distance of a circle is its circumference up to the chords' 1/24 (step/radius)^2") {
  const double radius_m = 3.0;
  const Trajectory t = sampled(2 * std::numbers::pi, 1e-3, [&](double a) {
    return StampedPose{
        0, {radius_m * std::cos(a), radius_m * std::sin(a), 1.0}, Eigen::Quaterniond::Identity()};
  });
  const std::vector<double> d = travelled_distance_m(t.poses);
  CHECK(d.front() == 0.0);
  CHECK(d.back() == doctest::Approx(2 * std::numbers::pi * radius_m).epsilon(1e-3));
  for (std::size_t i = 1; i < d.size(); ++i) REQUIRE(d[i] >= d[i - 1]);
  CHECK(d[1000] == doctest::Approx(radius_m).epsilon(1e-3));
}

TEST_CASE("position noise of a robot at rest is not travel") {
  const Trajectory t = sampled(100.0, 0.1, [](double s) {
    return StampedPose{
        0, {0.004 * std::sin(91 * s), 0.004 * std::cos(57 * s), 0.0}, Eigen::Quaterniond::Identity()};
  });
  CHECK(travelled_distance_m(t.poses).back() < 0.05);
}

TEST_CASE("yaw is the last of the rotations roll, pitch, yaw about fixed axes") {
  const Eigen::Quaterniond q = yaw_rotation(2.5) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX());
  CHECK(yaw_rad(q) == doctest::Approx(2.5));
  CHECK(wrap_angle_rad(2.5 + 4 * std::numbers::pi) == doctest::Approx(2.5));
}

}  // namespace isobar::test::test_trajectory
