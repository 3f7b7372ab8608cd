// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/errors.hpp"
#include "tools/web/file_view.hpp"

namespace isobar::test::test_file_view {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("isobar-file-view-" + std::to_string(::getpid()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(path / name) << content;
  }
};

const char* const kTrajectory =
    "1700000000.000000000 1 2 3 0 0 0 1\n1700000000.100000000 1.5 2 3 0 0 0.7071068 0.7071068\n"
    "1700000000.200000000 2 2 3 0 0 1 0\n";

}  // namespace

TEST_CASE("a run of which there is only the trajectory is shown") {
  const Folder folder;
  folder.write("trajectory.tum", kTrajectory);
  web::MapTiles map(1);
  const Json json = Json::parse(web::read_run(folder.path, map).json);
  CHECK(json["kind"] == "run");
  CHECK(json["origin_ns"] == "1700000000000000000");
  CHECK(json["poses"]["t_s"] == Json::array({0.0, 0.1, 0.2}));
  CHECK(json["poses"]["x_m"] == Json::array({1.0, 1.5, 2.0}));
  CHECK(json["poses"]["yaw_deg"][1] == 90.0);
  CHECK(json["poses"]["bias_m"] == Json::array({nullptr, nullptr, nullptr}));
  CHECK(json["map"]["points"] == 0);
}

TEST_CASE("status, counters and settings of a run are shown with what was lost") {
  const Folder folder;
  folder.write("trajectory.tum", kTrajectory);
  folder.write("status.csv",
               "t_ns,mode,sd_z_m,altimeter_height_m,altimeter_bias_m,altimeter_bias_sd_m,altimeter_faulty\n"
               "1700000000000000000,initializing,nan,nan,0,0,0\n"
               "1700000000100000000,registered,0.02,3.25,0.25,0.05,1\n"
               "1700000000200000000,registered,0.02,3.5,0.5,0.05,0\n");
  folder.write("counters.csv",
               "name,count,first_message\nlidar packets lost,7,\"first at 3 s\"\nimu: good rows,20,\"\"\n");
  folder.write("settings.toml", "# a comment\nlidar.port = 2369\n");
  web::MapTiles map(1);
  const Json json = Json::parse(web::read_run(folder.path, map).json);
  CHECK(json["poses"]["altimeter_m"] == Json::array({nullptr, 3.25, 3.5}));
  CHECK(json["poses"]["registered"] == Json::array({0, 1, 1}));
  std::string told;
  for (const Json& entry : json["health"])
    told += entry["level"].get<std::string>() + ": " + entry["message"].get<std::string>() + "\n";
  CHECK(told.find("warning: 7: first at 3 s") != std::string::npos);
  CHECK(told.find("warning: departs from the map") != std::string::npos);
  const auto port = std::find_if(json["settings"].begin(), json["settings"].end(),
                                 [](const Json& setting) { return setting["key"] == "lidar.port"; });
  REQUIRE(port != json["settings"].end());
  CHECK((*port)["value"] == "2369");
  CHECK((*port)["source"] == "settings.toml:2");
  CHECK((*port)["is_default"] == false);
}

TEST_CASE(
    "a damaged map or bad settings are left out and told, and a folder without a trajectory is refused") {
  const Folder folder;
  folder.write("trajectory.tum", kTrajectory);
  folder.write("map.ply", "ply\nnonsense\n");
  folder.write("settings.toml", "lidar.port = \"x\"\n");
  web::MapTiles map(1);
  const Json json = Json::parse(web::read_run(folder.path, map).json);
  CHECK(json["health"].dump().find("the map is left out") != std::string::npos);
  CHECK(json["health"].dump().find("the settings are left out") != std::string::npos);
  fs::remove(folder.path / "trajectory.tum");
  CHECK_THROWS_AS((void)web::read_run(folder.path, map), DataError);
}

TEST_CASE("a recording is shown with its sensors and curves") {
  const Folder folder;
  folder.write("recording.toml", "version = 1\n[barometer]\nfile = \"barometer.csv\"\n");
  std::string rows = "t_ns,pressure_pa,temperature_c\n";
  for (int i = 0; i < 50; ++i) {
    rows += std::to_string(1'700'000'000'000'000'000 + i * 100'000'000LL) + "," +
            std::to_string(100'000 + i) + ",20\n";
  }
  folder.write("barometer.csv", rows);
  const Json json = Json::parse(web::read_recording(folder.path, [](double) {}).json);
  CHECK(json["kind"] == "recording");
  REQUIRE(json["sensors"].size() == 1);
  CHECK(json["sensors"][0]["samples"] == 50);
  CHECK(json["sensors"][0]["rate_hz"] == 10.0);
  REQUIRE(json["signals"].size() == 1);
  CHECK(json["signals"][0]["series"][0]["values"][49] == 100'049.0);
  CHECK(json["signals"][0]["t_s"][49] == 4.9);
}

}  // namespace isobar::test::test_file_view
