// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tools/web/map_tiles.hpp"

namespace isobar::test::test_map_tiles {

namespace {

using web::MapDraft;
using web::MapTiles;

/// A viewer as the page is one: keeps what /api/map brings.
struct Viewer {
  struct Point {
    double x_m, y_m, z_m;
    int intensity;
  };
  std::uint32_t epoch = 0;
  std::uint32_t change = 0;
  std::uint32_t chunks = 0;  ///< that the last update brought
  std::size_t answers = 0;   ///< of the last update
  std::map<std::array<std::int32_t, 3>, std::vector<Point>> tiles;

  template <typename Value>
  static Value take(const std::string& bytes, std::size_t& at) {
    REQUIRE(at + sizeof(Value) <= bytes.size());
    Value value{};
    std::memcpy(&value, bytes.data() + at, sizeof(Value));
    at += sizeof(Value);
    return value;
  }

  void update(const MapTiles& map) {
    chunks = 0;
    answers = 0;
    for (bool more = true; more; ++answers) more = take_answer(map.changes_since(epoch, change));
  }

  bool take_answer(const std::string& bytes) {
    std::size_t at = 8;
    const auto its_epoch = take<std::uint32_t>(bytes, at);
    if (its_epoch != epoch) tiles.clear();
    epoch = its_epoch;
    change = take<std::uint32_t>(bytes, at);
    const bool more = take<std::uint32_t>(bytes, at) != 0;
    const double edge_m = take<float>(bytes, at);
    const double step_m = take<float>(bytes, at);
    const auto count = take<std::uint32_t>(bytes, at);
    for (std::uint32_t i = 0; i < count; ++i) take_tile(bytes, at, edge_m, step_m);
    CHECK(at == bytes.size());
    chunks += count;
    return more;
  }

  void take_tile(const std::string& bytes, std::size_t& at, double edge_m, double step_m) {
    std::array<std::int32_t, 3> index{};
    for (std::int32_t& number : index) number = take<std::int32_t>(bytes, at);
    const auto points = take<std::uint32_t>(bytes, at);
    static_cast<void>(take<std::uint32_t>(bytes, at));
    std::vector<Point>& tile = tiles[index];
    tile.clear();
    for (std::uint32_t i = 0; i < points; ++i) {
      std::array<double, 3> place{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = index[axis] * edge_m + take<std::uint16_t>(bytes, at) * step_m;
      }
      tile.push_back({place[0], place[1], place[2], take<std::uint16_t>(bytes, at)});
    }
    if (tile.empty()) tiles.erase(index);
  }

  [[nodiscard]] std::vector<Point> points() const {
    std::vector<Point> all;
    for (const auto& [index, tile] : tiles) all.insert(all.end(), tile.begin(), tile.end());
    return all;
  }
};

}  // namespace

TEST_CASE("a viewer gets every point within half a millimetre, on both sides of the origin") {
  MapTiles map(7);
  MapDraft draft;
  const std::vector<std::array<double, 3>> places{
      {0.0, 0.0, 0.0}, {-0.001, 16.3839, 3.0}, {-1000.25, 77.7, -9.0}, {16.384, -16.384, 1e-9}};
  for (const auto& [x, y, z] : places) draft.add(x, y, z, 200);
  map.replace(std::move(draft));
  Viewer viewer;
  viewer.update(map);
  const auto points = viewer.points();
  REQUIRE(points.size() == places.size());
  for (const std::array<double, 3>& place : places) {
    const bool found = std::any_of(points.begin(), points.end(), [&](const Viewer::Point& point) {
      // A step is 0.25 mm, and its float is right to 1e-7 of itself.
      return std::abs(point.x_m - place[0]) < 5e-4 && std::abs(point.y_m - place[1]) < 5e-4 &&
             std::abs(point.z_m - place[2]) < 5e-4 && point.intensity == 200;
    });
    CHECK_MESSAGE(found, place[0] << " " << place[1] << " " << place[2]);
  }
}

TEST_CASE(
    "a viewer that is up to date gets only the cubes that have changed, also those that are empty now") {
  MapTiles map(1);
  const auto replace = [&](double moved_m, bool with_far) {
    MapDraft draft;
    // In another order each time: a cube is judged by its points.
    if (moved_m > 0.0) draft.add(5.0, 5.0, 5.0, 1);
    draft.add(1.0 + moved_m, 1.0, 1.0, 1);
    if (moved_m == 0.0) draft.add(5.0, 5.0, 5.0, 1);
    draft.add(100.0, 1.0, 1.0, 1);
    if (with_far) draft.add(500.0, 1.0, 1.0, 1);
    map.replace(std::move(draft));
  };
  Viewer viewer;
  replace(0.0, true);
  viewer.update(map);
  CHECK(viewer.chunks == 3);
  replace(0.0, true);
  viewer.update(map);
  CHECK(viewer.chunks == 0);
  replace(0.01, true);
  viewer.update(map);
  CHECK(viewer.chunks == 1);
  replace(0.01, false);
  viewer.update(map);
  CHECK(viewer.chunks == 1);
  CHECK(viewer.points().size() == 3);
  CHECK(map.state().points == 3);
  Viewer late;
  late.update(map);
  CHECK(late.points().size() == 3);
}

TEST_CASE("a viewer of another map frame, or of another server, begins anew") {
  MapTiles map(1);
  MapDraft draft;
  draft.add(1.0, 1.0, 1.0, 1);
  map.replace(std::move(draft));
  Viewer viewer;
  viewer.update(map);
  map.start_over();
  viewer.update(map);
  CHECK(viewer.points().empty());
  MapDraft next;
  next.add(2.0, 2.0, 2.0, 1);
  map.replace(std::move(next));
  viewer.update(map);
  REQUIRE(viewer.points().size() == 1);
  CHECK(viewer.points()[0].x_m == doctest::Approx(2.0));
  // A change that this server never had.
  Viewer stranger;
  stranger.epoch = 12'345;
  stranger.change = 4'000'000'000;
  stranger.update(map);
  CHECK(stranger.points().size() == 1);
}

TEST_CASE("a large map comes in bounded answers, all of it") {
  MapTiles map(1);
  MapDraft draft;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  constexpr std::size_t kPoints = 800'000;
  for (std::size_t i = 0; i < kPoints; ++i) draft.add(place(random), place(random), 0.1 * place(random), 1);
  map.replace(std::move(draft));
  CHECK(map.changes_since(0, 0).size() < 2 * MapTiles::kAnswerBytes);
  Viewer viewer;
  viewer.update(map);
  CHECK(viewer.answers > 2);
  CHECK(viewer.points().size() == kPoints);
}

TEST_CASE("points that are not finite or absurdly far are left out and counted") {
  MapDraft draft;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2e6, -1e300}) {
    draft.add(bad, 0.0, 0.0, 1);
    draft.add(0.0, 0.0, bad, 1);
  }
  draft.add(1.0, 2.0, 3.0, 1);
  CHECK(draft.points() == 1);
  CHECK(draft.left_out() == 8);
}

}  // namespace isobar::test::test_map_tiles
