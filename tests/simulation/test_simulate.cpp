// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulate.hpp"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/manifest.hpp"
#include "simulation/lidar_plan.hpp"

namespace isobar::test::test_simulate {

using namespace isobar::simulation;
namespace fs = std::filesystem;

namespace {

/// Temporary folder, deleted at the end of the test.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (fs::temp_directory_path() / "isobar-simulate-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Scratch() { fs::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] fs::path operator/(const char* name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

std::map<std::string, std::string> read_all(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    files[entry.path().filename().string()] = text.str();
  }
  return files;
}

ScenarioRequest brief(const char* name, std::uint64_t seed) {
  ScenarioRequest request;
  request.name = name;
  request.seed = seed;
  request.short_form = true;
  request.stop_after_s = 0.7;
  return request;
}

}  // namespace

TEST_CASE("the same seed gives byte-identical files, another seed different ones") {
  const Scratch scratch;
  for (const ScenarioInfo& info : scenarios()) {
    CAPTURE(info.name);
    const std::string name = info.name;
    simulate(brief(name.c_str(), 5), scratch / (name + "-a").c_str(), {});
    simulate(brief(name.c_str(), 5), scratch / (name + "-b").c_str(), {});
    simulate(brief(name.c_str(), 6), scratch / (name + "-c").c_str(), {});
    const auto first = read_all(scratch / (name + "-a").c_str());
    const auto second = read_all(scratch / (name + "-b").c_str());
    const auto other = read_all(scratch / (name + "-c").c_str());
    const bool wheels = name != "moulin";
    CHECK(first.size() == (wheels ? 9 : 8));
    CHECK(first.count("wheel.csv") == (wheels ? 1 : 0));
    for (const auto& entry : first) {
      const auto& file = entry.first;
      const auto& bytes = entry.second;
      CAPTURE(file);
      CHECK(bytes.size() > 50);
      CHECK((second.at(file) == bytes));
      CHECK((other.at(file) != bytes));
    }
  }
}

TEST_CASE("progress increases to one") {
  const Scratch scratch;
  double last = 0.0;
  bool falls = false;
  simulate(brief("moulin", 1), scratch / "run", [&](double fraction) {
    falls = falls || fraction < last;
    last = fraction;
  });
  CHECK_FALSE(falls);
  CHECK(last == doctest::Approx(1.0));
}

TEST_CASE("an unknown scenario is a usage error that lists the known ones") {
  const Scratch scratch;
  std::string message;
  try {
    simulate(brief("forty-floors", 1), scratch / "run", {});
  } catch (const isobar::UsageError& error) {
    message = error.what();
  }
  for (const ScenarioInfo& info : scenarios()) CHECK(message.find(info.name) != std::string::npos);
  CHECK_FALSE(fs::exists(scratch / "run"));
}

TEST_CASE("an unknown lidar is a usage error that lists the known ones, before anything is written") {
  const Scratch scratch;
  ScenarioRequest request = brief("moulin", 1);
  request.lidar = "VLP-17";
  std::string message;
  try {
    simulate(request, scratch / "run", {});
  } catch (const isobar::UsageError& error) {
    message = error.what();
  }
  CHECK(message.find("VLP-17") != std::string::npos);
  for (const LidarPlan& plan : lidar_plans()) CHECK(message.find(plan.name) != std::string::npos);
  CHECK_FALSE(fs::exists(scratch / "run"));
}

TEST_CASE(
    "a recording tells its lidar: model, ports and an Ouster's metadata; its name tells any but a VLP-16") {
  const Scratch scratch;
  ScenarioRequest request = brief("moulin", 1);
  request.stop_after_s = 0.05;
  const std::string usual = recording_name(request);
  std::vector<std::string> warnings;
  for (const LidarPlan& plan : lidar_plans()) {
    CAPTURE(plan.name);
    request.lidar = plan.name;
    const std::string name = recording_name(request);
    CHECK((name == usual) == (plan.name == kUsualLidar));
    CHECK(name.find(' ') == std::string::npos);
    const fs::path folder = scratch / name.c_str();
    simulate(request, folder, {});
    const auto manifest = isobar::recording::read_manifest(folder, warnings);
    REQUIRE(manifest.lidar);
    CHECK(manifest.lidar->model == plan.name);
    CHECK(manifest.lidar->port == plan.port);
    CHECK(manifest.lidar->info_port == plan.info_port);
    CHECK(manifest.lidar->calibration_file.empty() == (plan.maker != LidarMaker::kOuster));
    CHECK(fs::exists(folder / manifest.lidar->calibration_file));
  }
  CHECK(warnings.empty());
}

}  // namespace isobar::test::test_simulate
