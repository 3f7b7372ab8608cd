// SPDX-License-Identifier: BSD-3-Clause
// The grid of a floor in shared memory: pieces, changes, repetition. The test makes the grids and is the subscriber.
#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/floor_grid_publisher.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::test::test_floor_grid {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Cells that differ from row to row, and by `seed`.
OccupancyGrid grid_of(int width, int height, int seed) {
  OccupancyGrid grid;
  grid.origin_m = {-3.0, 4.0};
  grid.height_m = 3.5;
  grid.width = width;
  grid.height = height;
  for (int i = 0; i < width * height; ++i) {
    grid.cells.push_back(static_cast<std::int8_t>((i / 7 + seed) % 102) - 1);
  }
  return grid;
}

/// Publisher, subscriber and the time of the test's clock.
class Bench {
 public:
  Bench() {
    for (int i = 0; i < 100 && !publisher.is_due({.floor = 99}, 0); ++i) std::this_thread::sleep_for(10ms);
    REQUIRE(publisher.is_due({.floor = 99}, 0));  // connected
  }
  /// Steps every 0.1 s.
  /// @return pieces that came, as (sequence, first row)
  std::vector<std::pair<std::uint32_t, std::uint32_t>> run(double time_s) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pieces;
    for (const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(time_s * 1e9); now_ns < end_ns;
         now_ns += kSecondNs / 10) {
      publisher.step(now_ns);
      while (const auto piece = subscriber.take()) {
        pieces.emplace_back(piece->sequence, piece->first_row);
        if (piece->first_row == 0) cells.clear();
        cells.insert(cells.end(), piece->cells, piece->cells + piece->row_count * piece->width);
        last = {piece->width, piece->height};
        name = piece->floor_name;
      }
    }
    return pieces;
  }

  ipc::Broker broker;
  FloorGridPublisher publisher;
  ipc::Subscriber<ipc::FloorGrid> subscriber{ipc::topics::kFloorGrid};
  std::int64_t now_ns = 100 * kSecondNs;
  std::vector<std::int8_t> cells;
  std::pair<std::uint32_t, std::uint32_t> last;
  std::string name;
};

using Pieces = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

TEST_CASE("a grid of three megabytes comes whole, in pieces of whole rows, one a step") {
  Bench bench;
  const OccupancyGrid grid = grid_of(1500, 2000, 0);
  REQUIRE(bench.publisher.offer(grid, {.floor = 2, .floor_name = "third floor"}, bench.now_ns));
  CHECK(bench.run(0.35) == Pieces{{1, 0}, {1, 699}, {1, 1398}});
  CHECK(bench.cells == grid.cells);
  CHECK(bench.last == std::pair(1500U, 2000U));
  CHECK(bench.name == "third floor");
}

TEST_CASE("an equal grid is no news, a change waits for a second, another floor does not wait") {
  Bench bench;
  const GridOrigin ground{.floor = 0};
  REQUIRE(bench.publisher.offer(grid_of(100, 50, 0), ground, bench.now_ns));
  CHECK(bench.run(0.5) == Pieces{{1, 0}});
  CHECK_FALSE(bench.publisher.is_due(ground, bench.now_ns));
  CHECK_FALSE(bench.publisher.offer(grid_of(100, 50, 1), ground, bench.now_ns));
  CHECK(bench.run(0.6).empty());
  CHECK_FALSE(bench.publisher.offer(grid_of(100, 50, 0), ground, bench.now_ns));  // equal
  CHECK(bench.run(1.0).empty());
  CHECK(bench.publisher.offer(grid_of(100, 50, 1), ground, bench.now_ns));
  CHECK(
      bench.publisher.offer(grid_of(1500, 2000, 2), {.floor = 1}, bench.now_ns));  // before the other is sent
  CHECK(bench.run(0.1) == Pieces{{3, 0}});
  CHECK(bench.publisher.offer(grid_of(100, 50, 1), {.session = 2, .floor = 1}, bench.now_ns));
  CHECK(bench.run(0.3) == Pieces{{4, 0}});
}

TEST_CASE("the newest grid comes again, for subscribers that come later") {
  Bench bench;
  REQUIRE(bench.publisher.offer(grid_of(100, 50, 0), {}, bench.now_ns));
  CHECK(bench.run(4.9) == Pieces{{1, 0}});
  CHECK(bench.run(5.0) == Pieces{{1, 0}});
}

TEST_CASE("malformed grids are refused and counted, and lose nothing that was good") {
  Bench bench;
  const OccupancyGrid good = grid_of(100, 50, 0);
  REQUIRE(bench.publisher.offer(good, {}, bench.now_ns));
  bench.run(2.0);
  std::vector<OccupancyGrid> bad(5, good);
  bad[0].width = 101;
  bad[1].cells.pop_back();
  bad[2].origin_m.x() = std::numeric_limits<double>::quiet_NaN();
  bad[3].resolution_m = 0.0;
  bad[4] = {};
  for (const OccupancyGrid& grid : bad) CHECK_FALSE(bench.publisher.offer(grid, {}, bench.now_ns));
  CHECK(bench.publisher.refused() == 5);
  bench.cells.clear();
  CHECK(bench.run(5.0) == Pieces{{1, 0}});
  CHECK(bench.cells == good.cells);
}

}  // namespace

}  // namespace isobar::test::test_floor_grid
