// SPDX-License-Identifier: BSD-3-Clause
// The map thread takes a map that was laid anew after a loop. The test is registration, loops and subscriber.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/loop_stage.hpp"
#include "daemon/map_thread.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/core/loops/ring_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_moved_map_live {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Dead reckoning goes wrong by 40 cm between 29 and 38 m, where no scan sees it.
Eigen::Isometry3d unseen(double way_m) {
  return way_m < 30.0 ? Eigen::Isometry3d::Identity()
                      : Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.26, 0.0));
}

Config configured(const fs::path& run) {
  Config config;
  config.output.directory = run;
  return config;
}

/// Share of the points on the disk that lie on walls of the ring.
double share_on_walls_of(const fs::path& map_folder) {
  const auto store = FileTileStore::open_to_read(map_folder);
  std::vector<MapPoint> points;
  std::vector<std::byte> bytes;
  for (const TileKey& key : store->keys()) {
    REQUIRE(store->take(key, bytes));
    REQUIRE(MapTile::append_stored_points(bytes, points));
  }
  REQUIRE(points.size() > 1000);
  return share_on_walls(points);
}

/// Map thread and loop stage of one run, in lock step but for the thread.
class Run {
 public:
  explicit Run(const fs::path& folder)
      : config_(configured(folder)), stores_(config_), opened_(stores_.open(1)) {
    REQUIRE(opened_ != nullptr);
  }

  void start(StageSettings& stages) {
    stages.T_base_lidar = RingRun::lidar_mount();
    loops_ = std::make_unique<LoopStage>(
        stages,
        std::make_unique<LoopFiles>([this](std::uint32_t session) { return stores_.folder_of(session); },
                                    map_header(config_), map_limits(config_), 1.0));
    map_ = std::make_unique<MapThread>(stages.map, stages.T_base_lidar, 0.0, stores_, RunStart{},
                                       ThreadSettings{.name = "map"});
    map_->worker().start();
  }
  /// One scan through both.
  void add(const RegisteredScan& scan) {
    RegisteredScan* loaned = scans_.loan();
    REQUIRE(loaned != nullptr);
    loaned->pose = scan.pose;
    loaned->handed_over_ns = scan.pose.stamp_ns;
    loaned->point_count = scan.point_count;
    std::copy_n(scan.points, scan.point_count, loaned->points);
    scans_.publish(loaned);
    loops_->add_prior(Prior{});
    if (auto moved = loops_->add_scan(scan)) {
      T_now_before = moved->T_now_before;
      map_->offer(std::make_unique<MovedMap>(std::move(*moved)));
      was_offered = true;
    }
  }
  [[nodiscard]] MapMove move() { return map_->snapshots().pin()->move(); }
  /// Waits for the map thread, which takes a map with the next wake-up.
  bool waits_for_move() {
    for (int i = 0; i < 1000 && move().number == 0; ++i) std::this_thread::sleep_for(10ms);
    return move().number == 1;
  }
  void stop() { map_.reset(); }

  Eigen::Isometry3d T_now_before = Eigen::Isometry3d::Identity();
  bool was_offered = false;

 private:
  Config config_;
  MapStores stores_;
  FileTileStore* opened_;
  ipc::Publisher<RegisteredScan> scans_{ipc::topics::kRegisteredScan};
  std::unique_ptr<LoopStage> loops_;
  std::unique_ptr<MapThread> map_;
};

TEST_CASE("after a loop the map thread goes on in a map that was laid anew, on the disk as in memory") {
  const ipc::Broker broker;
  const TemporaryFolder folder;
  const fs::path map_folder = folder.path() / "run" / "map";
  Run run(folder.path() / "run");
  StageSettings stages = stage_settings(configured(folder.path() / "run"));
  run.start(stages);
  RingRun ring(unseen);
  while (ring.way_m() < 29.0) run.add(ring.next());
  ring.carry(9.0);
  while (ring.way_m() < 70.0 && !run.was_offered) run.add(ring.next());
  REQUIRE(run.was_offered);
  REQUIRE(run.waits_for_move());
  const double moved_way_m = ring.way_m();
  while (ring.way_m() < moved_way_m + 5.0) {
    RegisteredScan scan = ring.next();
    scan.pose.T_map_base = run.T_now_before * scan.pose.T_map_base;
    scan.pose.map_moves = 1;
    run.add(scan);
  }
  run.stop();
  // One wall where there were two: 95 % but for corners, where a cell has points of two walls.
  CHECK(share_on_walls_of(map_folder) > 0.95);
  CHECK(!fs::exists(map_folder.string() + ".next"));
  CHECK(!fs::exists(map_folder.string() + ".old"));
  const auto building = BuildingStore::open_to_read(map_folder);
  REQUIRE(building != nullptr);
  CHECK(building->stored().moved_ns.size() == 1);
  CHECK(!building->stored().loops.empty());
}

}  // namespace
}  // namespace isobar::test::test_moved_map_live
