// SPDX-License-Identifier: BSD-3-Clause
// The map thread's cloud in shared memory. The test is registration and subscriber.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/map_cloud.hpp"
#include "daemon/map_thread.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/support/temporary_folder.hpp"

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
  // A busy map thread leaves scans out for newer ones; their rows come again.
  const auto seen_enough = [&] { return complete_maps >= 2 && largest_total > ipc::MapCloud::kMaxPoints; };
  for (std::uint32_t i = 0; i < 400 && !seen_enough(); ++i) {
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

/// Fills a scan of a wall of 8 x 4 m, 5 m in front of a robot at (x_m, 0, 0).
void fill_wall(RegisteredScan& scan, std::uint32_t sequence, double x_m) {
  scan.pose = PoseEstimate{};
  scan.pose.mode = PoseMode::kRegistered;
  scan.pose.sequence = sequence;
  scan.pose.stamp_ns = 1'000'000'000'000 + 2'000'000'000LL * sequence;
  scan.pose.T_map_base.translation().x() = x_m;
  scan.handed_over_ns = scan.pose.stamp_ns;
  scan.point_count = 0;
  for (int row = 0; row < 16; ++row) {
    for (int column = 0; column < 32; ++column) {
      ScanPoint& point = scan.points[scan.point_count++];
      point = {};
      point.x_m = 5.1F;
      point.y_m = static_cast<float>((column - 15.5) * 0.25);
      point.z_m = static_cast<float>((row - 7.5) * 0.25);
    }
  }
}

/// The points of the clouds, put together from their pieces.
class Clouds {
 public:
  void take() {
    while (const auto piece = clouds_.take()) {
      if (piece->first_point == 0) points_.clear();
      for (std::uint32_t k = 0; k < piece->point_count; ++k) points_.push_back(piece->points[k]);
      if (points_.size() == piece->total_points) last_ = points_;
    }
  }
  /// Points of the last whole cloud with x_m in [from, from + 20).
  [[nodiscard]] std::size_t count(double from) const {
    return static_cast<std::size_t>(std::count_if(last_.begin(), last_.end(), [from](const ScanPoint& point) {
      return point.x_m >= from && point.x_m < from + 20.0;
    }));
  }
  [[nodiscard]] std::size_t count() const { return last_.size(); }
  [[nodiscard]] bool has_point_twice() const {
    std::set<std::tuple<float, float, float>> known;
    return std::any_of(last_.begin(), last_.end(), [&known](const ScanPoint& point) {
      return !known.emplace(point.x_m, point.y_m, point.z_m).second;
    });
  }

 private:
  ipc::Subscriber<ipc::MapCloud> clouds_{ipc::topics::kMapCloud};
  std::vector<ScanPoint> points_;
  std::vector<ScanPoint> last_;
};

TEST_CASE(
    "the map cloud has the tiles that are only on disk, and each tile once, wherever the robot drives") {
  const ipc::Broker broker;
  const TemporaryFolder folder;
  ipc::Publisher<RegisteredScan> scans(ipc::topics::kRegisteredScan);
  Clouds clouds;
  Config config;
  config.output.directory = folder.path() / "run";
  MapStores stores(config);
  REQUIRE(stores.open(1) != nullptr);
  MapConfig map_config;
  map_config.see_through_limit = 0;
  map_config.radius_m = 50.0;
  MapThread map(map_config, Eigen::Isometry3d::Identity(), 2.0, stores, RunStart{}, {.name = "map"});
  map.worker().start();
  std::uint32_t sequence = 0;
  const auto stay_at = [&](double x_m) {
    for (int i = 0; i < 12; ++i) {
      RegisteredScan* scan = scans.loan();
      REQUIRE(scan != nullptr);
      fill_wall(*scan, sequence++, x_m);
      scans.publish(scan);
      std::this_thread::sleep_for(40ms);
      clouds.take();
    }
  };
  stay_at(0.0);
  const std::size_t wall = clouds.count();
  CHECK(wall > 400);
  CHECK(clouds.count(0.0) == wall);
  stay_at(300.0);
  CHECK(clouds.count(0.0) == wall);
  CHECK(clouds.count(300.0) > 400);
  stay_at(600.0);
  const std::size_t all = clouds.count();
  CHECK(clouds.count(0.0) + clouds.count(300.0) + clouds.count(600.0) == all);
  CHECK(clouds.count(600.0) > 400);
  stay_at(0.0);
  CHECK(clouds.count() == all);
  CHECK(clouds.count(300.0) > 400);
}

TEST_CASE("tiles that leave memory or come back while a cloud is read are in it once") {
  const ipc::Broker broker;
  const TemporaryFolder folder;
  Clouds clouds;
  MapConfig config;
  config.see_through_limit = 0;
  config.radius_m = 50.0;
  const auto store = FileTileStore::create(folder.path() / "map", {32 * config.cell_m, config.cell_m}, {});
  LocalMap map(config, Eigen::Isometry3d::Identity(), store.get());
  MapCloudPublisher publisher(1.0, 0);  // one tile a step
  const auto scan = std::make_unique<RegisteredScan>();
  std::uint32_t sequence = 0;
  const auto stay_at = [&](double x_m, int scans, bool with_cloud) {
    for (int i = 0; i < scans; ++i) {
      fill_wall(*scan, sequence++, x_m);
      map.update(*scan);
      if (with_cloud) publisher.step(map, store.get(), scan->pose);
      clouds.take();
    }
  };
  for (const double x_m : {0.0, 300.0, 600.0}) stay_at(x_m, 12, false);
  map.store_all();
  // Begun at 600, where the tiles of 300 are read first; then those come back, and those of 600 leave.
  stay_at(600.0, 2, true);
  REQUIRE(clouds.count() == 0);
  for (int i = 0; i < 40 && clouds.count() == 0; ++i) stay_at(300.0, 1, true);  // the first cloud only
  CHECK_FALSE(clouds.has_point_twice());
  for (const double x_m : {0.0, 300.0, 600.0}) CHECK(clouds.count(x_m) > 400);
  CHECK(clouds.count(0.0) + clouds.count(300.0) + clouds.count(600.0) == clouds.count());
}

}  // namespace

}  // namespace isobar::test::test_map_cloud
