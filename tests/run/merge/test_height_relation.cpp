// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "core/altitude/hypsometry.hpp"
#include "run/files/checkpoint.hpp"
#include "run/merge/height_relation.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_height_relation {
namespace {

using files::height_relation;

/// Datum of a run that began at a height above the base station, which it reads as zero.
HeightDatum begun_at(double above_base_m, double offset_m = 0.0) {
  HeightDatum datum;
  datum.known = true;
  datum.station_known[0] = true;
  // scale ln(reference / pressure) = offset at the start: the reference is the pressure there, but for the offset.
  datum.offset_m = offset_m;
  datum.station_offset_log[0] = (offset_m - above_base_m) / hypsometric_scale_m(kZeroCelsiusK + 15.0);
  return datum;
}

TEST_CASE("a run that began two storeys higher has its origin there, whatever the barometers' offsets") {
  const auto relation = height_relation(begun_at(1.0, 0.7), begun_at(7.8, -12.0));
  REQUIRE(relation.has_value());
  CHECK(relation->z_a_b_m == doctest::Approx(6.8).epsilon(1e-9));
  CHECK(relation->sigma_m >= 0.3);
  CHECK(3.0 * relation->sigma_m < 3.0);  // it tells the storey
}

TEST_CASE("nothing ties the heights without a datum, a common base station, or within reason") {
  HeightDatum other = begun_at(0.0);
  other.station_known = {false, true};
  CHECK_FALSE(height_relation(begun_at(0.0), other).has_value());
  CHECK_FALSE(height_relation(begun_at(0.0), HeightDatum{}).has_value());
  CHECK_FALSE(height_relation(begun_at(0.0), begun_at(2500.0)).has_value());
}

TEST_CASE("the checkpoint of a map is that in its folder, or that of its run and of its map frame") {
  const Scratch scratch;
  const std::filesystem::path run = scratch.path();
  std::filesystem::create_directories(run / "map");
  std::filesystem::create_directories(run / "map_2");
  CHECK_FALSE(files::checkpoint_of_map(run / "map").has_value());
  files::Checkpoint checkpoint;
  checkpoint.session = 2;
  checkpoint.datum = begun_at(3.0);
  files::write_checkpoint(run / "checkpoint", checkpoint);
  CHECK_FALSE(files::checkpoint_of_map(run / "map").has_value());
  CHECK(files::checkpoint_of_map(run / "map_2/").has_value());
  files::write_checkpoint(run / "map/checkpoint", checkpoint);
  CHECK(files::checkpoint_of_map(run / "map").has_value());
}

}  // namespace
}  // namespace isobar::test::test_height_relation
