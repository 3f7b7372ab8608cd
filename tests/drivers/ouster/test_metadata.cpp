// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "drivers/ouster/metadata.hpp"
#include "tests/drivers/ouster/packet_builder.hpp"

namespace isobar::test::test_metadata {
namespace {

using nlohmann::json;
using ouster::Metadata;
using ouster::parse_metadata;

/// The text of the error, or empty.
std::string error_of(const std::string& text, const char* model = "OS1") {
  try {
    static_cast<void>(parse_metadata(text, "os.json", model));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

std::string changed(bool nested, const std::function<void(json&)>& change) {
  json root = json::parse(build_ouster_metadata({}, nested));
  change(root);
  return root.dump(2);
}

}  // namespace

TEST_CASE("Both forms of an Ouster's metadata say the same") {
  OusterPlan plan;
  plan.profile = "RNG15_RFL8_NIR8";
  plan.columns_per_turn = 2'048;
  for (const bool nested : {false, true}) {
    CAPTURE(nested);
    const Metadata metadata = parse_metadata(build_ouster_metadata(plan, nested), "os.json", "OS1");
    CHECK(metadata.product_line == "OS-1-32");
    CHECK(metadata.serial == plan.serial);
    CHECK(metadata.init_id == plan.init_id);
    CHECK(metadata.profile->name == plan.profile);
    CHECK(metadata.pixels == 32);
    CHECK(metadata.columns_per_packet == 16);
    CHECK(metadata.columns_per_turn == 2'048);
    CHECK(metadata.turn_hz == 10.0);
    CHECK(metadata.altitude_deg.front() == 22.5);
    CHECK(metadata.beam_origin_x_mm == 15.806);
    CHECK(metadata.T_sensor_lidar(2, 3) == 36.18);
    CHECK(metadata.imu_profile == ouster::ImuProfile::kLegacy);
    CHECK(metadata.timestamp_mode ==
          (nested ? ouster::TimestampMode::kPtp : ouster::TimestampMode::kUnknown));
  }
}

TEST_CASE("Metadata of firmware 1.x, without a data format, means the LEGACY profile with 16 columns") {
  const Metadata metadata =
      parse_metadata(changed(false, [](json& root) { root.erase("data_format"); }), "f", "OS1");
  CHECK(metadata.profile->name == "LEGACY");
  CHECK(metadata.columns_per_packet == 16);
  CHECK(metadata.columns_per_turn == 1'024);
}

TEST_CASE("An error of the metadata names file, key and rule") {
  CHECK(error_of("{\n\"a\": 1,\n]").starts_with("os.json:3: is no JSON"));
  CHECK(error_of("{\"a\": 1e999}") == "os.json: holds a number that is too large: no sensor's metadata");
  CHECK(error_of("[1]") == "os.json: must hold one JSON object, an Ouster's metadata");
  CHECK(error_of(build_ouster_metadata({}, true, "OS-0-128")) ==
        "os.json: sensor_info.prod_line: \"OS-0-128\", but lidar.model = \"OS1\": another sensor's metadata");
  CHECK(error_of(changed(true, [](json& root) { root["beam_intrinsics"].erase("beam_altitude_angles"); })) ==
        "os.json: beam_intrinsics.beam_altitude_angles: is missing");
  CHECK(error_of(changed(false, [](json& root) { root["beam_altitude_angles"][3] = 95.0; })) ==
        "os.json: beam_altitude_angles[3]: must be -90 to 90");
  CHECK(error_of(changed(false, [](json& root) { root["beam_altitude_angles"][3] = "up"; })) ==
        "os.json: beam_altitude_angles[3]: must be -90 to 90");
  CHECK(
      error_of(changed(true, [](json& root) { root["beam_intrinsics"]["beam_azimuth_angles"].erase(0); })) ==
      "os.json: beam_intrinsics.beam_azimuth_angles: must hold as many angles as beam_altitude_angles");
  CHECK(error_of(changed(true, [](json& root) { root["lidar_data_format"]["pixels_per_column"] = 64; })) ==
        "os.json: lidar_data_format.pixels_per_column: contradicts beam_altitude_angles, which holds 32 "
        "angles");
  CHECK(error_of(changed(true, [](json& root) { root["lidar_data_format"]["columns_per_frame"] = 512; })) ==
        "os.json: lidar_data_format.columns_per_frame: contradicts lidar_mode, 1024 columns a turn");
  CHECK(error_of(changed(true, [](json& root) { root["lidar_data_format"]["columns_per_packet"] = 15.5; })) ==
        "os.json: lidar_data_format.columns_per_packet: must be a whole number");
  CHECK(error_of(changed(true, [](json& root) { root["config_params"]["lidar_mode"] = "fast"; })) ==
        "os.json: config_params.lidar_mode: must be like \"1024x10\", but is \"fast\"");
  CHECK(error_of(changed(true, [](json& root) {
          root["lidar_intrinsics"]["lidar_to_sensor_transform"][0] = 1;
        })) == "os.json: lidar_intrinsics.lidar_to_sensor_transform: must be a rotation and a translation");
  CHECK(error_of(changed(true, [](json& root) {
          root["lidar_intrinsics"]["lidar_to_sensor_transform"].erase(0);
        })) == "os.json: lidar_intrinsics.lidar_to_sensor_transform: must hold 16 numbers, row by row");
  CHECK(error_of(changed(true, [](json& root) { root["lidar_data_format"]["udp_profile_lidar"] = "OFF"; }))
            .starts_with("os.json: lidar_data_format.udp_profile_lidar: \"OFF\" is not decoded; set the "
                         "sensor to one of LEGACY, "));
  CHECK_THROWS_WITH_AS(static_cast<void>(ouster::read_metadata("/no/such.json", "OS1")),
                       "lidar.calibration_file: /no/such.json: cannot be read", ConfigError);
}

}  // namespace isobar::test::test_metadata
