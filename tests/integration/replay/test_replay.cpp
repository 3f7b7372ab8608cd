// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>

#include "config/config_io.hpp"
#include "daemon/stage_settings.hpp"
#include "run/files/map_export.hpp"
#include "run/recording/reference.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace isobar::test::test_replay {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("replaying a recording twice gives the same trajectory and map, bit for bit") {
  std::filesystem::path first;
  std::filesystem::path second;
  run(short_drive(), first);
  run(short_drive(), second);
  const std::string trajectory = bytes_of(first / "trajectory.tum");
  REQUIRE(trajectory.size() > 1000);
  CHECK(trajectory == bytes_of(second / "trajectory.tum"));
  const std::string map = bytes_of(first / "map.ply");
  REQUIRE(map.size() > 10'000);
  CHECK(map == bytes_of(second / "map.ply"));
}

TEST_CASE("the map of a run is complete in its folder, and map.ply is its export") {
  std::filesystem::path out;
  const ReplaySummary summary = run(short_drive(), out);
  const auto store = FileTileStore::open_to_read(out / "map");
  CHECK(store->tile_count() >= 8);  // a room with stairs, tiles of 8.8 m
  CHECK(store->header() == map_header(Config{}));
  const std::filesystem::path exported = out / "again.ply";
  const auto ply = files::open_point_file(exported);
  const files::MapExport done = files::export_map(*store, store->header(), std::nullopt, *ply);
  ply->close();
  CHECK(done.points == summary.map_points);
  CHECK(done.unreadable == 0);
  CHECK(bytes_of(exported) == bytes_of(out / "map.ply"));
}

TEST_CASE("a map at its size limit deletes tiles and counts them; the poses do not change") {
  Config config;
  config.map.cell_m = 0.15;  // small tiles: no single one exceeds the limit
  const std::filesystem::path whole = fresh_folder("whole-map");
  replay(short_drive(), config, whole, [](double) {});
  // Below the range of the setting, because the drive is short.
  const std::uint64_t limit = FileTileStore::open_to_read(whole / "map")->disk_bytes() * 3 / 4;
  config.map_files.max_disk_gb = static_cast<double>(limit) * 1e-9;
  const std::filesystem::path out = fresh_folder("small-map");
  const ReplaySummary summary = replay(short_drive(), config, out, [](double) {});
  // The map begins after 2.5 s at rest, in which gravity settles, and a second of bootstrap.
  CHECK(summary.registered >= summary.scans - 35);
  CHECK(count_of(summary, "map tiles forgotten at the limit") > 0);
  CHECK(count_of(summary, "map tiles missing in map.ply") == 0);
  CHECK(FileTileStore::open_to_read(out / "map")->disk_bytes() <= limit);
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(whole / "trajectory.tum"));
}

TEST_CASE("every scan gets a pose, in order, and nearly all are registered") {
  std::filesystem::path out;
  const ReplaySummary summary = run(short_drive(), out);
  CHECK(summary.scans >= 135);  // 14 s at 10 Hz, minus the cut ends
  CHECK(summary.poses >= summary.scans);
  // The map starts after the alignment of half a second: up to eight scans.
  // The map begins after 2.5 s at rest, in which gravity settles, and a second of bootstrap.
  CHECK(summary.registered >= summary.scans - 35);
  const auto poses = recording::read_tum(out / "trajectory.tum");
  CHECK(poses.size() == summary.poses);
  CHECK(std::is_sorted(poses.begin(), poses.end(),
                       [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; }));
}

TEST_CASE("every registered scan of a lidar at 1 Hz yields a pose, in order") {
  std::int64_t first_ns = 0;
  const auto slow = copy_with(
      short_drive(), "lidar-1hz", [](auto&) {},
      [&first_ns](const recording::Event& event, recording::RecordingWriter& writer) {
        std::vector<std::string> warnings;
        if (event.kind == recording::EventKind::kLidarPacket) {
          if (first_ns == 0) first_ns = event.stamp_ns;
          // Two revolutions a second, so that one is whole.
          if ((event.stamp_ns - first_ns) % 1'000'000'000 > 200'000'000) return;
        }
        write_event(event, recording::read_manifest(short_drive(), warnings), writer);
      });
  std::filesystem::path out;
  const ReplaySummary summary = run(slow, out);
  CHECK(summary.scans >= 26);
  CHECK(summary.registered >= summary.scans - 5);
  const auto poses = recording::read_tum(out / "trajectory.tum");
  for (std::size_t i = 1; i < poses.size(); ++i) CHECK(poses[i].stamp_ns > poses[i - 1].stamp_ns);
}

TEST_CASE("every method follows the drive") {
  // A few metres of travel: 15 cm for every method but dead reckoning, which drifts with the wheels' scale
  // and slip (up to a few per cent).
  for (const Method method : {Method::k3Dof, Method::k4Dof, Method::k6Dof, Method::k4DofAltitude,
                              Method::k6DofAltitude, Method::kOdometry}) {
    CAPTURE(static_cast<int>(method));
    std::filesystem::path out;
    run(short_drive(), out, method);
    CHECK(largest_error_m(short_drive(), out) < (method == Method::kOdometry ? 0.5 : 0.15));
  }
}

TEST_CASE("a run with the settings file of another run gives the same trajectory") {
  std::filesystem::path out;
  run(short_drive(), out);
  const Config again = load_config(out / "settings.toml");
  const std::filesystem::path out_again = fresh_folder("again");
  replay(short_drive(), again, out_again, [](double) {});
  CHECK(bytes_of(out / "trajectory.tum") == bytes_of(out_again / "trajectory.tum"));
}

}  // namespace isobar::test::test_replay
