// SPDX-License-Identifier: BSD-3-Clause
// The grid of a floor from its pieces, the frame on the ground, and hints, without a network.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "core/geometry.hpp"
#include "core/so3.hpp"
#include "ipc/dds/footprint.hpp"
#include "ipc/dds/grid_assembly.hpp"
#include "ipc/dds/messages.hpp"
#include "ipc/dds/pose_hints.hpp"

namespace isobar::test::test_dds_floors {

using namespace isobar::dds;

namespace {

constexpr std::uint32_t kWidth = 4;
constexpr std::uint32_t kHeight = 6;

/// Rows of a grid whose cells bear their numbers.
std::unique_ptr<ipc::FloorGrid> rows(std::uint32_t sequence, std::uint32_t first, std::uint32_t count) {
  auto piece = std::make_unique<ipc::FloorGrid>();
  piece->stamp_ns = 5'000'000'000 + sequence;
  piece->sequence = sequence;
  piece->session = 2;
  piece->z_m = 3.5;
  piece->resolution_m = 0.05;
  piece->origin_x_m = -10.0;
  piece->origin_y_m = 20.0;
  piece->width = kWidth;
  piece->height = kHeight;
  piece->first_row = first;
  piece->row_count = count;
  for (std::uint32_t i = 0; i < count * kWidth; ++i) {
    piece->cells[i] = static_cast<std::int8_t>(first * kWidth + i - 1);
  }
  return piece;
}

TEST_CASE("a grid is whole with its last rows, and is what Nav2's static layer reads") {
  GridAssembly grid;
  CHECK_FALSE(grid.add(*rows(1, 4, 2)));  // a late subscriber begins with the next one
  CHECK_FALSE(grid.add(*rows(2, 0, 4)));
  CHECK_FALSE(grid.complete());
  REQUIRE(grid.add(*rows(2, 4, 2)));
  CHECK(grid.session() == 2);
  const std::string frame = "map_2";
  const GridMessage& message = grid.message(frame, 1'000'000'000);
  CHECK(std::string(message.header.frame_id) == "map_2");
  CHECK(to_stamp_ns(message.header.stamp) == 6'000'000'002);
  CHECK(to_stamp_ns(message.info.map_load_time) == 6'000'000'002);
  CHECK(message.info.resolution == 0.05F);
  CHECK(message.info.width == kWidth);
  CHECK(message.info.height == kHeight);
  CHECK(message.info.origin.position.x == -10.0);
  CHECK(message.info.origin.position.y == 20.0);
  CHECK(message.info.origin.position.z == 3.5);
  CHECK(message.info.origin.orientation.w == 1.0);
  REQUIRE(message.data._length == kWidth * kHeight);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    CHECK(static_cast<std::int8_t>(message.data._buffer[i]) == static_cast<std::int8_t>(i) - 1);
  }
}

TEST_CASE("a grid that is sent again is no news, and half a grid leaves the one before") {
  GridAssembly grid;
  REQUIRE(grid.add(*rows(7, 0, kHeight)));
  CHECK_FALSE(grid.add(*rows(7, 0, 3)));
  CHECK_FALSE(grid.add(*rows(7, 3, 3)));
  CHECK_FALSE(grid.add(*rows(8, 0, 2)));
  CHECK_FALSE(grid.add(*rows(8, 3, 3)));  // row 2 was lost
  CHECK(grid.complete());
  const std::string frame = "map";
  CHECK(to_stamp_ns(grid.message(frame, 0).header.stamp) == 5'000'000'007);
  CHECK(grid.add(*rows(8, 0, kHeight)));
  CHECK(grid.refused() == 0);
}

TEST_CASE("pieces that cannot be are counted, and lose nothing that was good") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(ipc::FloorGrid&)> broken[] = {
      // NOLINT(modernize-avoid-c-arrays)
      [](ipc::FloorGrid& p) { p.width = 0; },
      [](ipc::FloorGrid& p) { p.row_count = 0; },
      [](ipc::FloorGrid& p) { p.row_count = kHeight + 1; },
      [](ipc::FloorGrid& p) { p.first_row = kHeight; },
      [](ipc::FloorGrid& p) { p.first_row = UINT32_MAX; },
      [](ipc::FloorGrid& p) { p.width = 8'001, p.height = 8'000, p.row_count = 1; },  // more than 64 million
      [](ipc::FloorGrid& p) { p.width = UINT32_MAX, p.height = UINT32_MAX, p.row_count = UINT32_MAX; },
      [](ipc::FloorGrid& p) { p.width = 1'100'000, p.height = 1, p.row_count = 1; },  // beyond the piece
      [nan](ipc::FloorGrid& p) { p.origin_x_m = nan; },
      [](ipc::FloorGrid& p) { p.origin_y_m = 1e300; },
      [nan](ipc::FloorGrid& p) { p.z_m = nan; },
      [nan](ipc::FloorGrid& p) { p.resolution_m = nan; },
      [](ipc::FloorGrid& p) { p.resolution_m = 0.0; }};
  GridAssembly grid;
  REQUIRE(grid.add(*rows(1, 0, kHeight)));
  std::uint64_t refused = 0;
  for (const auto& break_it : broken) {
    auto piece = rows(2, 0, kHeight);
    break_it(*piece);
    CAPTURE(refused);
    CHECK_FALSE(grid.add(*piece));
    CHECK(grid.refused() == ++refused);
    CHECK(grid.complete());
  }
}

TEST_CASE("the frame on the ground lies under the robot, level, with its yaw") {
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();
  const double pitch_rad = 10.0 * kRadPerDeg;
  T_odom_base.linear() = rotation_from_rpy({0.0, pitch_rad, 1.2}).toRotationMatrix();
  T_odom_base.translation() = Eigen::Vector3d(3.0, -2.0, 1.0);
  const Eigen::Isometry3d T = footprint_of(T_odom_base, 0.4);
  CHECK((T.linear() - rotation_about_z(1.2)).norm() < 1e-12);
  CHECK((T.translation().head<2>() - T_odom_base.translation().head<2>()).norm() < 1e-12);
  // On the plane through the point 0.4 m under the robot, perpendicular to its up.
  const Eigen::Vector3d under = T_odom_base * Eigen::Vector3d(0.0, 0.0, -0.4);
  CHECK(std::abs((T.translation() - under).dot(T_odom_base.linear().col(2))) < 1e-12);
}

/// A hint as RViz sends it: 0.5 m, 15 degrees, no height.
PoseMessage rviz_hint() {
  PoseMessage message{};
  message.header.frame_id = text("map");
  message.pose.pose.position = {4.0, -3.0, 0.0};
  message.pose.pose.orientation = {0.0, 0.0, std::sin(0.35), std::cos(0.35)};
  message.pose.covariance[0] = message.pose.covariance[7] = 0.25;
  message.pose.covariance[35] = 0.0685;
  return message;
}

TEST_CASE("a hint of RViz says x, y and yaw, and nothing of the height") {
  ipc::PoseHint hint;
  REQUIRE(to_hint(rviz_hint(), "map", hint) == nullptr);
  CHECK(hint.source == ipc::PoseHintSource::kDds);
  CHECK(hint.session == 1);
  CHECK(hint.x_m == 4.0);
  CHECK(hint.y_m == -3.0);
  CHECK(std::abs(hint.yaw_rad - 0.7) < 1e-12);
  CHECK_FALSE(hint.has_z);
  CHECK(hint.covariance[35] == 0.0685);
  PoseMessage with_height = rviz_hint();
  with_height.pose.pose.position.z = 3.25;
  with_height.pose.covariance[14] = 0.01;
  REQUIRE(to_hint(with_height, "map", hint) == nullptr);
  CHECK(hint.has_z);
  CHECK(hint.z_m == 3.25);
}

TEST_CASE("the frame of a hint is a map frame, whose number it keeps, or empty") {
  const auto session = [](const char* frame) {
    PoseMessage message = rviz_hint();
    message.header.frame_id = text(frame);
    ipc::PoseHint hint;
    return to_hint(message, "r1/map", hint) == nullptr ? static_cast<int>(hint.session) : -1;
  };
  CHECK(session("") == 0);
  CHECK(session("r1/map") == 1);
  CHECK(session("/r1/map") == 1);
  CHECK(session("r1/map_12") == 12);
  for (const char* other :
       {"odom", "map", "r1/map_", "r1/map_1", "r1/map_0", "r1/map_2x", "r1/map2", "r1/map_-2"}) {
    CAPTURE(other);
    CHECK(session(other) == -1);
  }
}

TEST_CASE("a hint that cannot be is refused by its rule, and leaves the one before") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(PoseMessage&)> broken[] = {
      // NOLINT(modernize-avoid-c-arrays)
      [nan](PoseMessage& m) { m.pose.pose.position.x = nan; },
      [](PoseMessage& m) { m.pose.pose.position.y = 1e9; },
      [](PoseMessage& m) {
        m.pose.pose.orientation = {0, 0, 0, 0};
      },
      [](PoseMessage& m) { m.pose.pose.orientation.w = 2.0; },
      [nan](PoseMessage& m) { m.pose.pose.orientation.x = nan; },
      [nan](PoseMessage& m) { m.pose.covariance[3] = nan; },
      [](PoseMessage& m) { m.pose.covariance[0] = -0.25; },
      [](PoseMessage& m) { m.pose.covariance[1] = 0.1; },                          // not symmetric
      [](PoseMessage& m) { m.pose.covariance[1] = m.pose.covariance[6] = 0.3; }};  // beyond the variances
  ipc::PoseHint hint;
  for (const auto& break_it : broken) {
    PoseMessage message = rviz_hint();
    break_it(message);
    CHECK(to_hint(message, "map", hint) != nullptr);
    CHECK(hint.x_m == 0.0);
  }
}

}  // namespace

}  // namespace isobar::test::test_dds_floors
