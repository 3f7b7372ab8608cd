// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "core/errors.hpp"
#include "core/so3.hpp"
#include "run/building/building_log.hpp"
#include "run/building/building_store.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_building_store {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlenty = 1U << 30;

Eigen::Isometry3d pose_number(int n) {
  return Eigen::Translation3d(0.5 * n, -2.0, 0.1 * n) * rotation_from_rpy({0.01, -0.02, 0.1 * n});
}

std::unique_ptr<RegisteredScan> scan_number(int n, std::uint32_t points = 500) {
  auto scan = std::make_unique<RegisteredScan>();
  scan->pose.stamp_ns = n * 500'000'000LL;
  scan->pose.mode = PoseMode::kRegistered;
  scan->pose.T_map_base = pose_number(n);
  scan->point_count = points;
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto value = static_cast<float>(std::sin(0.37 * (n + 1) * (i + 1)));
    scan->points[i] = {30.0F * value, 3.0F - value, value * value, 0, 0, 7};
  }
  return scan;
}

KeyScan key_number(int n) {
  KeyScan key;
  key.stamp_ns = n * 500'000'000LL;
  key.way_m = 0.5 * n;
  key.T_map_base = pose_number(n);
  key.T_submap_base = pose_number(n % 10);
  key.map_moves = n > 15 ? 1 : 0;
  if (n % 2 == 0) key.air = AirHeight{0.1 * n, 1e-4};
  return key;
}

/// Two submaps of ten key scans, a loop and a move.
void write_building(BuildingStore& store) {
  for (std::uint32_t number = 0; number < 2; ++number) {
    Submap submap;
    submap.number = number;
    submap.stamp_ns = number * 5'000'000'000LL;
    submap.first_way_m = 5.0 * number;
    submap.air = AirHeight{0.5, 2e-4};
    submap.link.T_before_submap = pose_number(static_cast<int>(number));
    submap.link.covariance = 0.01 * Matrix6d::Identity();
    store.add_submap(submap);
    for (int i = 0; i < 10; ++i) {
      const int n = 10 * static_cast<int>(number) + i;
      KeyScan key = key_number(n);
      store.add_key(number, key, *scan_number(n));
      CHECK(key.scan != kNoScanHandle);
    }
  }
  Loop loop;
  loop.submap = 0;
  loop.holder = 1;
  loop.T_submap_base = pose_number(3);
  loop.covariance = 2e-4 * Matrix6d::Identity();
  loop.overlap = 0.9;
  store.add_loop(loop);
  store.add_move(8'000'000'000);
}

fs::path log_of(const fs::path& map) { return map / kBuildingFolder / "building.log"; }

TEST_CASE("a building is read as it was written, scans within the unit of their points") {
  const TemporaryFolder folder;
  write_building(*BuildingStore::open_to_continue(folder.path(), kPlenty));
  for (const bool read_only : {false, true}) {
    const auto store = read_only ? BuildingStore::open_to_read(folder.path())
                                 : BuildingStore::open_to_continue(folder.path(), kPlenty);
    const StoredBuilding& stored = store->stored();
    REQUIRE(stored.submaps.size() == 2);
    CHECK(stored.submaps[1].first_way_m == 5.0);
    CHECK(stored.submaps[1].last_way_m == 9.5);
    CHECK(stored.submaps[1].air->variance_m2 == 2e-4);
    CHECK(stored.submaps[1].link.T_before_submap.isApprox(pose_number(1), 1e-12));
    CHECK(stored.submaps[1].link.covariance == Matrix6d(0.01 * Matrix6d::Identity()));
    REQUIRE(stored.loops.size() == 1);
    CHECK(stored.loops[0].holder == 1);
    CHECK(stored.loops[0].overlap == 0.9);
    CHECK(stored.moved_ns == std::vector<std::int64_t>{8'000'000'000});
    const auto scan = std::make_unique<RegisteredScan>();
    for (int n = 0; n < 20; ++n) {
      const KeyScan& key =
          stored.submaps[static_cast<std::size_t>(n / 10)].keys[static_cast<std::size_t>(n % 10)];
      CHECK(key.way_m == 0.5 * n);
      CHECK(key.T_map_base.isApprox(pose_number(n), 1e-12));
      CHECK(key.map_moves == (n > 15 ? 1 : 0));
      CHECK(key.air.has_value() == (n % 2 == 0));
      REQUIRE(store->read_scan(key.scan, *scan));
      const auto truth = scan_number(n);
      REQUIRE(scan->point_count == truth->point_count);
      // Half a unit of 30 m / 32000.
      for (std::uint32_t i = 0; i < scan->point_count; ++i) {
        CHECK(std::abs(scan->points[i].x_m - truth->points[i].x_m) < 5e-4F);
      }
    }
    CHECK(store->counters().damaged == 0);
  }
}

TEST_CASE("a log that is cut anywhere loses its last record and nothing before, and is continued") {
  const TemporaryFolder folder;
  write_building(*BuildingStore::open_to_continue(folder.path(), kPlenty));
  const std::string whole = content_of(log_of(folder.path()));
  for (std::size_t size = 64; size < whole.size(); size += 97) {
    CAPTURE(size);
    write_content(log_of(folder.path()), whole.substr(0, size));
    std::size_t keys = 0;
    {
      const auto store = BuildingStore::open_to_continue(folder.path(), kPlenty);
      for (const Submap& submap : store->stored().submaps) keys += submap.keys.size();
      const auto at_most = static_cast<std::size_t>(fs::file_size(log_of(folder.path())));
      CHECK(at_most + store->counters().removed_bytes == size);
      store->add_move(5);
    }
    const auto again = BuildingStore::open_to_continue(folder.path(), kPlenty);
    std::size_t keys_again = 0;
    for (const Submap& submap : again->stored().submaps) keys_again += submap.keys.size();
    CHECK(keys_again == keys);
    CHECK(again->stored().moved_ns.back() == 5);
    CHECK(again->counters().removed_bytes == 0);
  }
}

TEST_CASE("a bit that turned in the log ends it there, and one in a scan loses that scan") {
  const TemporaryFolder folder;
  write_building(*BuildingStore::open_to_continue(folder.path(), kPlenty));
  const fs::path part = folder.path() / kBuildingFolder / "00000001.scans";
  std::string points = content_of(part);
  points[points.size() / 2] = static_cast<char>(points[points.size() / 2] ^ 1);
  write_content(part, points);
  {
    const auto store = BuildingStore::open_to_read(folder.path());
    const auto scan = std::make_unique<RegisteredScan>();
    int read = 0;
    for (const Submap& submap : store->stored().submaps) {
      for (const KeyScan& key : submap.keys) read += store->read_scan(key.scan, *scan) ? 1 : 0;
    }
    CHECK(read == 19);
    CHECK(store->counters().damaged == 1);
  }
  std::string log = content_of(log_of(folder.path()));
  log[log.size() / 2] = static_cast<char>(log[log.size() / 2] ^ 1);
  write_content(log_of(folder.path()), log);
  const auto store = BuildingStore::open_to_read(folder.path());
  CHECK(store->stored().submaps.size() == 1);
  CHECK(store->counters().removed_bytes > 0);
}

TEST_CASE("a log of a later format and a file of others are refused in words, and stay as they are") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / kBuildingFolder);
  write_content(log_of(folder.path()), "somebody's notes about a building");
  CHECK_THROWS_WITH_AS(static_cast<void>(BuildingStore::open_to_continue(folder.path(), kPlenty)),
                       doctest::Contains("is not the log of a building"), DataError);
  CHECK(content_of(log_of(folder.path())) == "somebody's notes about a building");
}

TEST_CASE("a map without a building has none to read") {
  const TemporaryFolder folder;
  CHECK(BuildingStore::open_to_read(folder.path()) == nullptr);
}

TEST_CASE("one process at a time writes a building, and others may read it meanwhile") {
  const TemporaryFolder folder;
  const auto store = BuildingStore::open_to_continue(folder.path(), kPlenty);
  write_building(*store);
  CHECK_THROWS_AS(static_cast<void>(BuildingStore::open_to_continue(folder.path(), kPlenty)), ServiceError);
  CHECK(BuildingStore::open_to_read(folder.path())->stored().loops.size() == 1);
}

TEST_CASE(
    "what a full disk refuses of the log is written when it has room, in its order; its scans are missing") {
  const TemporaryFolder folder;
  {
    const auto store = BuildingStore::open_to_continue(folder.path(), kPlenty);
    // The kernel refuses files beyond this size as a full disk does, by a part of a write.
    rlimit unlimited{};
    getrlimit(RLIMIT_FSIZE, &unlimited);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit full{64, unlimited.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
    Submap submap;
    store->add_submap(submap);
    KeyScan lost = key_number(1);
    store->add_key(0, lost, *scan_number(1));
    CHECK(lost.scan == kNoScanHandle);
    setrlimit(RLIMIT_FSIZE, &unlimited);
    KeyScan kept = key_number(2);
    store->add_key(0, kept, *scan_number(2));
    CHECK(kept.scan != kNoScanHandle);
    CHECK(store->counters().refused > 0);
  }
  const auto store = BuildingStore::open_to_read(folder.path());
  REQUIRE(store->stored().submaps.size() == 1);
  CHECK(store->stored().submaps[0].keys.size() == 2);
  CHECK(store->counters().removed_bytes == 0);
  const auto scan = std::make_unique<RegisteredScan>();
  CHECK(store->read_scan(store->stored().submaps[0].keys[1].scan, *scan));
}

TEST_CASE("a building that cannot be begun is begun when the disk takes it, with all that came before") {
  const TemporaryFolder folder;
  const fs::path in_the_way = folder.path() / kBuildingFolder;  // as a full disk: no folder can be made
  write_content(in_the_way, "");
  {
    const auto store = BuildingStore::open_to_continue(folder.path(), kPlenty);
    CHECK(store->stored().submaps.empty());
    store->add_submap(Submap());
    KeyScan lost = key_number(1);
    store->add_key(0, lost, *scan_number(1));
    CHECK(lost.scan == kNoScanHandle);
    CHECK(store->counters().first_refusal.find("cannot be begun") != std::string::npos);
    CHECK(!store->sync());
    fs::remove(in_the_way);
    store->add_move(5);
    KeyScan kept = key_number(2);
    store->add_key(0, kept, *scan_number(2));
    CHECK(kept.scan != kNoScanHandle);
    CHECK(store->sync());
  }
  const auto store = BuildingStore::open_to_continue(folder.path(), kPlenty);
  REQUIRE(store->stored().submaps.size() == 1);
  CHECK(store->stored().submaps[0].keys.size() == 2);
  CHECK(store->stored().moved_ns == std::vector<std::int64_t>{5});
  const auto scan = std::make_unique<RegisteredScan>();
  CHECK(store->read_scan(store->stored().submaps[0].keys[1].scan, *scan));
}

TEST_CASE("beyond the limit the oldest scans go, and the log stays") {
  const TemporaryFolder folder;
  // Scans of 80 kB: a part holds 420.
  const auto store = BuildingStore::open_to_continue(folder.path(), 1);
  Submap submap;
  store->add_submap(submap);
  const auto scan = scan_number(1, 10'000);
  KeyScan first;
  KeyScan last;
  store->add_key(0, first, *scan);
  for (int i = 0; i < 450; ++i) store->add_key(0, last, *scan);
  CHECK(store->counters().forgotten == 1);
  const auto out = std::make_unique<RegisteredScan>();
  CHECK(!store->read_scan(first.scan, *out));
  CHECK(store->read_scan(last.scan, *out));
}

}  // namespace
}  // namespace isobar::test::test_building_store
