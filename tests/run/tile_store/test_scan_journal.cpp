// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/so3.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "run/tile_store/scan_journal.hpp"
#include "tests/run/tile_store/tiles.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_scan_journal {
namespace {

namespace fs = std::filesystem;

constexpr int kPoints = 200;

/// Scan number `n` of a robot that drives along x, a metre a scan.
std::unique_ptr<RegisteredScan> scan_number(int n, double step_m = 1.0) {
  auto scan = std::make_unique<RegisteredScan>();
  scan->pose.sequence = static_cast<std::uint32_t>(n);
  scan->pose.stamp_ns = n * 100'000'000LL;
  scan->pose.mode = PoseMode::kRegistered;
  scan->pose.overlap = 0.5;
  scan->pose.T_map_base.linear() = rotation_about_z(0.01 * n);
  scan->pose.T_map_base.translation() = Eigen::Vector3d(n * step_m, -2.0, 0.5);
  scan->point_count = kPoints;
  for (int i = 0; i < kPoints; ++i) {
    const auto value = static_cast<float>(std::sin(0.37 * (n + 1) * (i + 1)));
    scan->points[i] = {40.0F * value, 3.0F - value, value * value, 0, 0, static_cast<std::uint8_t>(i)};
  }
  return scan;
}

std::vector<std::uint32_t> sequences_in(const fs::path& folder) {
  std::vector<std::uint32_t> found;
  ScanJournal::read(folder, [&](const RegisteredScan& scan) { found.push_back(scan.pose.sequence); });
  return found;
}

void write_scans(ScanJournal& journal, int first, int behind_last) {
  for (int n = first; n < behind_last; ++n) journal.add(*scan_number(n));
}

fs::path only_part(const fs::path& folder) {
  const auto numbers = file_numbers(folder, kScansExtension);
  REQUIRE(numbers.size() == 1);
  return numbered_file(folder, numbers[0], kScansExtension);
}

using Numbers = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("scans come back in their order, to the resolution of the journal") {
  const TemporaryFolder folder;
  ScanJournal journal(folder.path());
  write_scans(journal, 0, 5);
  // 40 m in 32000 steps of 1.25 mm, rounded: 0.63 mm a coordinate.
  constexpr float kResolutionM = 0.00063F;
  int n = 0;
  ScanJournal::read(folder.path(), [&](const RegisteredScan& read) {
    const auto written = scan_number(n++);
    CHECK(read.pose.T_map_base.isApprox(written->pose.T_map_base, 1e-12));
    CHECK(read.pose.stamp_ns == written->pose.stamp_ns);
    CHECK(read.pose.mode == PoseMode::kRegistered);
    REQUIRE(read.point_count == written->point_count);
    for (int i = 0; i < kPoints; ++i) {
      CHECK(std::abs(read.points[i].x_m - written->points[i].x_m) < kResolutionM);
      CHECK(std::abs(read.points[i].y_m - written->points[i].y_m) < kResolutionM);
      CHECK(std::abs(read.points[i].z_m - written->points[i].z_m) < kResolutionM);
      CHECK(read.points[i].intensity == written->points[i].intensity);
    }
  });
  CHECK(n == 5);
}

TEST_CASE("a journal cut at any byte gives the scans before the cut, whole") {
  const TemporaryFolder folder;
  {
    ScanJournal journal(folder.path());
    write_scans(journal, 0, 3);
  }
  const fs::path part = only_part(folder.path());
  const std::string whole = content_of(part);
  const std::size_t record = whole.size() / 3;
  for (std::size_t size = 0; size < whole.size(); size += 13) {
    write_content(part, whole.substr(0, size));
    CHECK(sequences_in(folder.path()).size() == size / record);
  }
}

TEST_CASE("a flipped bit loses no scan before it and none of other parts") {
  const TemporaryFolder folder;
  ScanJournal journal(folder.path());
  write_scans(journal, 0, 3);
  journal.begin_sweep(true);
  write_scans(journal, 3, 5);
  const fs::path part = numbered_file(folder.path(), 0, kScansExtension);
  const std::string whole = content_of(part);
  const std::size_t record = whole.size() / 3;
  for (std::size_t at = record; at < 2 * record; at += 31) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    write_content(part, damaged);
    CHECK(sequences_in(folder.path()) == Numbers{0, 3, 4});
  }
}

TEST_CASE(
    "a scan stays until the tiles of a whole sweep that began after it have had time to reach the disk") {
  const TemporaryFolder folder;
  ScanJournal journal(folder.path());
  write_scans(journal, 0, 2);
  journal.begin_sweep(true);  // this sweep writes what scans 0 and 1 changed
  write_scans(journal, 2, 4);
  CHECK(sequences_in(folder.path()) == Numbers{0, 1, 2, 3});
  SUBCASE("and that sweep was whole") {
    journal.begin_sweep(true);
    CHECK(sequences_in(folder.path()) == Numbers{0, 1, 2, 3});
    write_scans(journal, 4, 6);
    journal.begin_sweep(true);
    CHECK(sequences_in(folder.path()) == Numbers{2, 3, 4, 5});
    journal.begin_sweep(true);
    CHECK(sequences_in(folder.path()) == Numbers{4, 5});
  }
  SUBCASE("and the disk refused a tile of it") {
    for (int i = 0; i < 5; ++i) journal.begin_sweep(false);
    CHECK(sequences_in(folder.path()) == Numbers{0, 1, 2, 3});
    journal.begin_sweep(true);
    journal.begin_sweep(true);
    CHECK(sequences_in(folder.path()).empty());
  }
}

TEST_CASE("the journal of a killed process is kept until its scans are in the tiles") {
  const TemporaryFolder folder;
  {
    ScanJournal killed(folder.path());
    write_scans(killed, 0, 3);
  }
  ScanJournal journal(folder.path());
  write_scans(journal, 3, 4);
  journal.begin_sweep(true);
  journal.begin_sweep(true);
  CHECK(sequences_in(folder.path()) == Numbers{0, 1, 2, 3});
  journal.begin_sweep(true);
  CHECK(sequences_in(folder.path()).empty());
}

TEST_CASE("a robot that stands writes one scan") {
  const TemporaryFolder folder;
  ScanJournal journal(folder.path());
  for (int n = 0; n < 20; ++n) journal.add(*scan_number(n, 0.02));
  CHECK(sequences_in(folder.path()) == Numbers{0});
}

TEST_CASE("tiles that are whatever late, with the journal, know the place as the map in memory did") {
  const TemporaryFolder folder;
  const MapConfig config;
  const auto store = FileTileStore::create(folder.path(), {8.8, config.cell_m}, {});
  ScanJournal journal(folder.path());
  LocalMap map(config, Eigen::Isometry3d::Identity(), store.get());
  // A straight corridor, 3 m wide: walls, floor.
  constexpr int kScans = 60;
  auto scan = std::make_unique<RegisteredScan>();
  const auto fill = [&](int n) {
    scan->pose.stamp_ns = n * 250'000'000LL;
    scan->pose.mode = PoseMode::kRegistered;
    scan->pose.overlap = 0.6;
    scan->pose.T_map_base.translation().x() = 0.25 * n;
    scan->point_count = 0;
    for (float x = -10.0F; x < 10.0F; x += 0.1F) {
      for (float along = -1.0F; along < 1.0F; along += 0.1F) {
        scan->points[scan->point_count++] = {x, 1.5F, along, 0, 0, 9};
        scan->points[scan->point_count++] = {x, -1.5F, along, 0, 0, 9};
        scan->points[scan->point_count++] = {x, 1.5F * along, -1.0F, 0, 0, 9};
      }
    }
  };
  for (int n = 0; n < kScans; ++n) {
    fill(n);
    if (map.update(*scan)) journal.add(*scan);
    if (n == 20) map.store_all();
  }
  LocalMap tiles_only(config, Eigen::Isometry3d::Identity(), store.get());
  tiles_only.load_around(scan->pose.T_map_base.translation());
  LocalMap continued(config, Eigen::Isometry3d::Identity(), store.get());
  continued.load_around(scan->pose.T_map_base.translation());
  ScanJournal::read(folder.path(), [&](const RegisteredScan& read) { continued.update(read); });
  // The journal has every second scan, and not the last one: of the planes, all but some at the edge of sight.
  const auto planes = static_cast<double>(map.snapshot()->plane_count());
  CHECK(static_cast<double>(continued.snapshot()->plane_count()) > 0.9 * planes);
  CHECK(static_cast<double>(tiles_only.snapshot()->plane_count()) < 0.8 * planes);
}

}  // namespace isobar::test::test_scan_journal
