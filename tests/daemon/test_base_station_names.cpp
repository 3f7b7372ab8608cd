// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base_station_names.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <string>

#include "daemon/checkpoint_draft.hpp"
#include "daemon/stored_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_base_station_names {

namespace {

constexpr std::uint32_t kSession = 1;

PoseEstimate registered_pose() {
  PoseEstimate pose;
  pose.mode = PoseMode::kRegistered;
  pose.session = kSession;
  pose.stamp_ns = 1'000'000'000;
  pose.T_map_base.translation() = Eigen::Vector3d(1.0, 2.0, 6.5);
  return pose;
}

/// Checkpoint of a run that heard its first base station.
files::Checkpoint checkpoint_of(const files::StationNames& names) {
  CheckpointDraft draft(names);
  draft.note(registered_pose());
  HeightDatum datum;
  datum.known = true;
  datum.height_m = 6.5;
  datum.station_known = {true, false};
  datum.station_offset_log = {0.002, 0.0};
  return draft.at(2'000'000'000, datum);
}

}  // namespace

TEST_CASE("a checkpoint names the base stations that were heard, and no others") {
  CHECK(checkpoint_of({"roof", "cellar"}).stations == files::StationNames{"roof", ""});
}

TEST_CASE("heights go on with the base station of the map, whether it is the first or the second one") {
  for (const std::size_t place : {0U, 1U}) {
    files::Checkpoint checkpoint = checkpoint_of({"roof", ""});
    files::StationNames names{"other", "another"};
    names.at(place) = "roof";
    CHECK(take_over_stations(checkpoint, names).empty());
    CHECK(checkpoint.datum.known);
    CHECK(checkpoint.datum.station_known.at(place));
    CHECK_FALSE(checkpoint.datum.station_known.at(1 - place));
    CHECK(checkpoint.datum.station_offset_log.at(place) == 0.002);
  }
}

TEST_CASE("heights of another base station are forgotten, and both are named") {
  files::Checkpoint checkpoint = checkpoint_of({"roof", ""});
  const std::string said = take_over_stations(checkpoint, {"mine", "tower"});
  CHECK(said.find("\"roof\"") != std::string::npos);
  CHECK(said.find("\"mine\" and \"tower\"") != std::string::npos);
  CHECK_FALSE(checkpoint.datum.known);
  CHECK_FALSE(checkpoint.datum.station_known[0]);
}

TEST_CASE("a checkpoint without names is believed") {
  files::Checkpoint checkpoint = checkpoint_of({"", ""});
  CHECK(take_over_stations(checkpoint, {"mine", ""}).empty());
  CHECK(checkpoint.datum.known);
  CHECK(checkpoint.datum.station_known[0]);
}

TEST_CASE(
    "a session in the map of another base station begins without a height, and the map stays as it is") {
  const TemporaryFolder folder;
  const MapHeader header;
  write_map_header(folder.path(), header);
  const auto file = folder.path() / "checkpoint";
  files::write_checkpoint(file, checkpoint_of({"roof", ""}));
  const StoredMap same = find_stored_map(folder.path(), header, {"roof", ""});
  CHECK(same.has_datum);
  CHECK(same.start.place->has_height);
  CHECK(height_note(same).empty());
  const StoredMap other = find_stored_map(folder.path(), header, {"mine", ""});
  CHECK_FALSE(other.has_datum);
  CHECK_FALSE(other.start.place->has_height);
  CHECK(other.start.place->T_map_base.translation().z() == 6.5);
  CHECK(height_note(other).find("\"roof\"") != std::string::npos);
  CHECK(files::read_checkpoint(file)->stations[0] == "roof");
}

}  // namespace isobar::test::test_base_station_names
