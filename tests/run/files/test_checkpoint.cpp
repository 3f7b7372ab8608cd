// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "core/errors.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/text_file.hpp"
#include "run/tile_store/tile_record.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_checkpoint {
namespace {

using files::Checkpoint;

Checkpoint example() {
  Checkpoint checkpoint;
  checkpoint.session = 3;
  checkpoint.stamp_ns = 1'700'000'000'123'456'789;
  checkpoint.clock_ns = checkpoint.stamp_ns + 80'000'000;
  checkpoint.T_map_base = Eigen::Translation3d(1.5, -200.25, 7.0) *
                          Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.1, -0.05, 0.99).normalized());
  checkpoint.v_map_m_s = {0.5, -0.25, 0.0};
  checkpoint.yaw_rate_rad_s = 0.375;
  checkpoint.overlap = 0.875;
  checkpoint.residual_rms_m = 0.0625;
  checkpoint.datum = {.known = true,
                      .stamp_ns = 1'700'000'000'000'000'001,
                      .height_m = 7.0,
                      .climb_m_s = -0.5,
                      .variance_m2 = 0.01,
                      .offset_m = -0.125,
                      .ground_moves = true,
                      .step_open = true,
                      .station_known = {true, false},
                      .station_offset_log = {0.001, 0.0}};
  checkpoint.stations = {"roof", ""};
  return checkpoint;
}

bool is_refused(std::span<const std::byte> bytes) {
  const char* rule = nullptr;
  return !files::decode(bytes, rule).has_value() && rule != nullptr;
}

}  // namespace

TEST_CASE("a checkpoint survives the way to the disk and back") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint";
  CHECK_FALSE(files::read_checkpoint(file).has_value());
  files::write_checkpoint(file, Checkpoint{});
  files::write_checkpoint(file, example());
  const auto read = files::read_checkpoint(file);
  REQUIRE(read.has_value());
  CHECK(read->session == 3);
  CHECK(read->stamp_ns == example().stamp_ns);
  CHECK(read->clock_ns == example().clock_ns);
  CHECK(read->T_map_base.matrix().isApprox(example().T_map_base.matrix(), 1e-14));
  CHECK(read->v_map_m_s == example().v_map_m_s);
  CHECK(read->yaw_rate_rad_s == 0.375);
  CHECK(read->overlap == 0.875);
  CHECK(read->residual_rms_m == 0.0625);
  CHECK(read->datum.known);
  CHECK(read->datum.step_open);
  CHECK(read->datum.ground_moves);
  CHECK(read->datum.stamp_ns == 1'700'000'000'000'000'001);
  CHECK(read->datum.climb_m_s == -0.5);
  CHECK(read->datum.height_m == 7.0);
  CHECK(read->datum.variance_m2 == 0.01);
  CHECK(read->datum.offset_m == -0.125);
  CHECK(read->datum.station_known[0]);
  CHECK_FALSE(read->datum.station_known[1]);
  CHECK(read->datum.station_offset_log[0] == 0.001);
  CHECK(read->stations == files::StationNames{"roof", ""});
}

TEST_CASE("the longest name of a base station is kept, and a longer one cut") {
  Checkpoint checkpoint = example();
  checkpoint.stations = {std::string(63, 'a'), std::string(200, 'b')};
  const char* rule = nullptr;
  const auto read = files::decode(files::encode(checkpoint), rule);
  REQUIRE(read.has_value());
  CHECK(read->stations == files::StationNames{std::string(63, 'a'), std::string(63, 'b')});
}

TEST_CASE("a checkpoint of version 1, without names of base stations, is read") {
  // Its fields are the first part of version 2.
  files::CheckpointBytes bytes = files::encode(example());
  const std::span<std::byte> old = std::span(bytes).first(216);
  old[8] = std::byte{1};
  const std::uint32_t length = 216;
  std::memcpy(old.data() + 12, &length, sizeof(length));
  const std::uint32_t crc = crc32_of(old.first(212));
  std::memcpy(old.data() + 212, &crc, sizeof(crc));
  const char* rule = nullptr;
  const auto read = files::decode(old, rule);
  REQUIRE(read.has_value());
  CHECK(read->datum.station_offset_log[0] == 0.001);
  CHECK(read->stations == files::StationNames{});
  CHECK(is_refused(bytes));  // the length of version 2 with the number of version 1
}

TEST_CASE("a checkpoint that is cut, or of which any bit is changed, is refused") {
  const files::CheckpointBytes good = files::encode(example());
  for (std::size_t length = 0; length < good.size(); ++length) {
    CHECK(is_refused(std::span(good).first(length)));
  }
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    files::CheckpointBytes bytes = good;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    CHECK(is_refused(bytes));
  }
}

TEST_CASE("a checkpoint with impossible values is refused, whatever its checksum says") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    Checkpoint checkpoint = example();
    change(checkpoint);
    return is_refused(files::encode(checkpoint));
  };
  CHECK_FALSE(refused([](Checkpoint&) {}));
  CHECK(refused([](Checkpoint& c) { c.session = 0; }));
  CHECK(refused([](Checkpoint& c) { c.overlap = 1.5; }));
  CHECK(refused([&](Checkpoint& c) { c.T_map_base.translation().x() = nan; }));
  CHECK(refused([&](Checkpoint& c) { c.T_map_base.linear().setConstant(nan); }));
  CHECK(refused([](Checkpoint& c) { c.v_map_m_s.y() = 1e6; }));
  CHECK(refused([](Checkpoint& c) { c.datum.variance_m2 = -1.0; }));
  CHECK(refused([&](Checkpoint& c) { c.datum.station_offset_log[1] = nan; }));
}

TEST_CASE("a damaged checkpoint file is named with the rule") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint";
  files::write_text_file(file, "");
  CHECK(message_of([&] { static_cast<void>(files::read_checkpoint(file)); }) ==
        file.string() + ": has another length than a checkpoint");
  files::write_text_file(file, std::string(files::kCheckpointBytes, 'x'));
  CHECK(message_of([&] { static_cast<void>(files::read_checkpoint(file)); }) ==
        file.string() + ": is no checkpoint of Isobar");
}

}  // namespace isobar::test::test_checkpoint
