// SPDX-License-Identifier: BSD-3-Clause
// The map thread's cloud in shared memory. The test is registration and subscriber.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <set>
#include <thread>
#include <utility>

#include "daemon/map_thread.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::test::test_map_cloud {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Points of a floor of 110 x 110 m, one in each cell of 0.275 m: 160 000, more than one piece holds.
constexpr int kRows = 400;
constexpr int kRowsPerScan = 80;
constexpr double kSpacingM = 0.275;

/// Publishes a scan with `kRowsPerScan` rows of the floor from `first_row` on, seen from 2 m above its centre.
void publish_rows(ipc::Publisher<RegisteredScan>& scans, std::uint32_t sequence, int first_row) {
  RegisteredScan* scan = scans.loan();
  REQUIRE(scan != nullptr);
  scan->pose = PoseEstimate{};
  scan->pose.mode = PoseMode::kRegistered;
  scan->pose.sequence = sequence;
  scan->pose.stamp_ns = 1'000'000'000'000 + 2'000'000'000LL * sequence;
  scan->handed_over_ns = scan->pose.stamp_ns;
  scan->point_count = 0;
  for (int row = first_row; row < first_row + kRowsPerScan; ++row) {
    for (int column = 0; column < kRows; ++column) {
      ScanPoint& point = scan->points[scan->point_count++];
      point = {};
      point.x_m = static_cast<float>((row - kRows / 2 + 0.5) * kSpacingM);
      point.y_m = static_cast<float>((column - kRows / 2 + 0.5) * kSpacingM);
      point.z_m = -2.0F;
    }
  }
  scans.publish(scan);
}

TEST_CASE("the map cloud is every point of the local map, in pieces that follow one another") {
  const ipc::Broker broker;
  ipc::Publisher<RegisteredScan> scans(ipc::topics::kRegisteredScan);
  ipc::Subscriber<ipc::MapCloud> clouds(ipc::topics::kMapCloud);
  MapConfig config;
  config.see_through_limit = 0;
  MapStores no_stores{Config{}};
  MapThread map(config, Eigen::Isometry3d::Identity(), 8.0, no_stores, RunStart{}, {.name = "map"});
  map.worker().start();
  std::uint32_t complete_maps = 0;
  std::uint32_t expected_first = 0;
  std::uint32_t largest_total = 0;
  std::set<std::pair<long, long>> points;
  for (std::uint32_t i = 0; i < 40; ++i) {
    publish_rows(scans, i, static_cast<int>(i) * kRowsPerScan % kRows);
    std::this_thread::sleep_for(60ms);
    while (const auto piece = clouds.take()) {
      if (piece->first_point == 0) points.clear();
      CHECK(piece->first_point == (piece->first_point == 0 ? 0 : expected_first));
      expected_first = piece->first_point + piece->point_count;
      REQUIRE(expected_first <= piece->total_points);
      for (std::uint32_t k = 0; k < piece->point_count; ++k) {
        points.emplace(std::lround(piece->points[k].x_m * 1000), std::lround(piece->points[k].y_m * 1000));
      }
      if (expected_first < piece->total_points) continue;
      ++complete_maps;
      CHECK(points.size() == piece->total_points);  // no point twice, none left out
      largest_total = std::max(largest_total, piece->total_points);
    }
  }
  CHECK(complete_maps >= 2);
  CHECK(largest_total > ipc::MapCloud::kMaxPoints);
}

}  // namespace

}  // namespace isobar::test::test_map_cloud
