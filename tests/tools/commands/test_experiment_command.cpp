// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_experiment_command {

using isobar::files::read_text_file;
using isobar::test::TemporaryFolder;

namespace {

int simulate(std::vector<std::string> words) {
  words.insert(words.begin(), {"simulate", "stairs-demo", "--short", "--stop-after", "0.1"});
  return isobar::test::exit_code(tools::add_simulate_command, std::move(words));
}

int experiment_all(std::vector<std::string> words) {
  words.insert(words.begin(), "all");
  return isobar::test::exit_code(tools::add_experiment_all_command, std::move(words));
}

}  // namespace

TEST_CASE("every fault that isobar simulate offers reaches the recording; each mistake is a usage error") {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "faults").string();
  CHECK(simulate({"--out",       out,         "--mount-error", "0.5",      "--drift",       "robot:0.5:60:70",
                  "--drift",     "base:-0.1", "--thermometer", "base:-20", "--base-silent", "60:120",
                  "--base-rate", "4",         "--common-ramp", "1:10",     "--common-gust", "3:0.2",
                  "--airflow",   "-0.3",      "--zones",       "1:4",      "--door-pulses", "1:8",
                  "--start-at",  "0.01",      "--without",     "imu",      "--without",     "wheels"}) == 0);
  const std::string manifest = read_text_file(out + "/recording.toml");
  for (const std::string option :
       {"--mount-error 0.5;", "--drift robot:0.5:60:70;", "--drift base:-0.1;", "--thermometer base:-20;",
        "--base-silent 60:120;", "--base-rate 4;", "--common-ramp 1:10;", "--common-gust 3:0.2;",
        "--airflow -0.3;", "--zones 1:4;", "--door-pulses 1:8;", "--start-at 0.01;", "--without imu;",
        "--without wheels;"}) {
    CAPTURE(option);
    CHECK(manifest.find(option) != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(out + "/imu.csv"));
  CHECK_FALSE(std::filesystem::exists(out + "/wheel.csv"));
  CHECK(std::filesystem::exists(out + "/base_barometer.csv"));

  const std::string never = (folder.path() / "never").string();
  for (const auto& wrong : std::vector<std::pair<std::string, std::string>>{{"--drift", "robot"},
                                                                            {"--drift", "car:1"},
                                                                            {"--drift", "robot:x"},
                                                                            {"--drift", "robot:1:-1"},
                                                                            {"--drift", "robot:1:0:0"},
                                                                            {"--drift", "robot:1:0:1:2"},
                                                                            {"--drift", ""},
                                                                            {"--drift", "robot:inf"},
                                                                            {"--thermometer", "robot:"},
                                                                            {"--thermometer", "robot:1:2"},
                                                                            {"--base-silent", "5"},
                                                                            {"--base-silent", "5:0"},
                                                                            {"--base-rate", "0"},
                                                                            {"--base-rate", "33"},
                                                                            {"--common-gust", "3"},
                                                                            {"--common-gust", "3:5"},
                                                                            {"--common-ramp", ""},
                                                                            {"--without", "lidar"},
                                                                            {"--mount-error", "-1"},
                                                                            {"--zones", "4:1"},
                                                                            {"--zones", "-1:2"},
                                                                            {"--door-pulses", "3"},
                                                                            {"--airflow", "much"},
                                                                            {"--start-at", "-1"},
                                                                            {"--start-at", "5"}}) {
    CAPTURE(wrong.first);
    CAPTURE(wrong.second);
    CHECK(simulate({"--out", never, wrong.first, wrong.second}) == 64);
  }
  CHECK_FALSE(std::filesystem::exists(never));
}

TEST_CASE("isobar experiment all replays every recording with every method, and can discard them") {
  const TemporaryFolder folder;
  const std::string out = folder.path().string();
  CHECK(experiment_all({"--scenarios", "moulin", "--seeds", "1", "--short", "--methods", "odometry,4dof",
                        "--mount-error", "1", "--discard", "--out", out}) == 0);
  const std::string table = read_text_file(out + "/experiment-all.txt");
  for (const char* text :
       {"moulin-1-short ", "moulin-1-short-mount-error-1 ", "4-DOF", "Odometry", "median"}) {
    CAPTURE(text);
    CHECK(table.find(text) != std::string::npos);
  }
  CHECK(table.find("FAILED") == std::string::npos);
  CHECK(table.find("6-DOF") == std::string::npos);
  const std::string json = read_text_file(out + "/experiment-all.json");
  CHECK(json.find("\"name\": \"moulin-1-short-mount-error-1\"") != std::string::npos);
  CHECK(json.find("\"z_rpe_median\"") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(out + "/moulin-1-short"));

  CHECK(experiment_all({"--scenarios", "castle", "--out", out}) == 64);
  CHECK(experiment_all({"--methods", "7dof", "--out", out}) == 64);
}

}  // namespace isobar::test::test_experiment_command
