// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <set>
#include <string>

#include "core/errors.hpp"
#include "drivers/lidar_models/lidar_models.hpp"

namespace isobar::test::test_lidar_models {

TEST_CASE("Every model of the registry makes a decoder of its name, or says which file it needs") {
  std::set<std::string> names;
  for (const LidarModel& model : lidar_models()) {
    const std::string name(model.name);
    CAPTURE(name);
    CHECK(names.insert(name).second);
    CHECK(model.port != model.info_port);
    LidarConfig config;
    config.model = name;
    if (model.needs_calibration) {
      CHECK_THROWS_AS(static_cast<void>(make_lidar_decoder(config)), ConfigError);
    } else {
      CHECK(make_lidar_decoder(config)->model() == name);
    }
  }
}

TEST_CASE("An Ouster's metadata makes the decoder of its own model only") {
  const auto folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "ouster";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: " << folder.string() << " is not on this machine");
    return;
  }
  LidarConfig config;
  config.calibration_file = folder / "OS-1-32-G_v2.1.1_1024x10.json";
  for (const char* name : {"OS0", "OS1", "OS2"}) {
    config.model = name;
    if (config.model == "OS1") {
      CHECK(make_lidar_decoder(config)->model() == "OS1");
    } else {
      CHECK_THROWS_AS(static_cast<void>(make_lidar_decoder(config)), ConfigError);
    }
  }
}

}  // namespace isobar::test::test_lidar_models
