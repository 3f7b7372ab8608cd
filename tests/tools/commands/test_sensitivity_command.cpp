// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/stamp.hpp"
#include "core/statistics/distribution.hpp"
#include "run/files/text_file.hpp"
#include "simulation/sensitivity_rig.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"
#include "tools/sensitivity_study.hpp"

namespace isobar::test::test_sensitivity_command {

using isobar::ErrorFigures;
using isobar::files::read_text_file;
using isobar::files::write_text_file;
using isobar::test::TemporaryFolder;
using simulation::RigPair;
using simulation::RigRequest;
using simulation::RigRun;

namespace {

int sensitivity(std::vector<std::string> words) {
  words.insert(words.begin(), "sensitivity");
  return isobar::test::exit_code(tools::add_sensitivity_command, std::move(words));
}

tools::SensorStudy study(const RigRequest& request, RigPair RigRun::*kind) {
  const RigRun rig = simulation::simulate_rig(request);
  const RigPair& pair = rig.*kind;
  std::vector<double> steps_s;
  for (const std::int64_t move_ns : rig.moves_ns) {
    steps_s.push_back(seconds_between(pair.moved.front().stamp_ns, move_ns));
  }
  tools::StudyOptions options;
  options.step_m = request.step_m;
  options.air_temperature_k = rig.air_temperature_c + 273.15;
  return tools::study_pair({"pair", pair.moved, pair.standing}, steps_s, options);
}

/// Figures over ten seeds: medians of each seed's median and standard deviation of the levels' errors.
ErrorFigures typical(RigPair RigRun::*kind, double distance_m) {
  std::vector<double> medians;
  std::vector<double> deviations;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RigRequest request;
    request.seed = seed;
    request.dwell_s = 30.0;
    request.distance_m = distance_m;
    const ErrorFigures figures = error_figures(study(request, kind).filtered_errors.steps_m);
    CHECK(figures.count == 10);
    medians.push_back(figures.median_m);
    deviations.push_back(figures.sd_m);
  }
  return {10, summarize(medians).median, summarize(deviations).median};
}

std::string csv(const std::vector<PressureSample>& samples) {
  std::string text = "t_ns,pressure_pa,temperature_c\n";
  for (const PressureSample& sample : samples) {
    text += std::to_string(sample.stamp_ns) + "," + std::to_string(sample.pressure_pa) + "," +
            std::to_string(sample.temperature_c) + "\n";
  }
  return text;
}

/// Writes the logs of a simulated rig with five steps of 13 cm into a folder.
RigRun write_rig(const std::string& folder) {
  RigRequest request;
  request.step_m = 0.13;
  request.steps = 5;
  request.dwell_s = 12.0;
  const RigRun rig = simulation::simulate_rig(request);
  std::filesystem::create_directories(folder);
  write_text_file(folder + "/barometer.csv", csv(rig.dps310.moved));
  write_text_file(folder + "/base_barometer.csv", csv(rig.dps310.standing));
  return rig;
}

}  // namespace

TEST_CASE(
    "ten steps of 3 cm: errors of a DPS310 pair and of a ceramic pair are within the experiment's limits") {
  // Limits: median 0.6 and sd 0.6 cm, ceramic 1.5 cm; with all air and sensor errors, rigs 1 m apart.
  const ErrorFigures mems = typical(&RigRun::dps310, 1.0);
  MESSAGE("DPS310: median ", 100.0 * mems.median_m, " cm, sd ", 100.0 * mems.sd_m, " cm");
  CHECK(mems.median_m < 0.006);
  CHECK(mems.sd_m < 0.006);
  const ErrorFigures ceramic = typical(&RigRun::ceramic, 1.0);
  MESSAGE("Setra 278: median ", 100.0 * ceramic.median_m, " cm, sd ", 100.0 * ceramic.sd_m, " cm");
  CHECK(ceramic.median_m < 0.015);
}

TEST_CASE("the simulated rig has its specified noise, and turbulence that grows with the distance") {
  RigRequest request;
  request.dwell_s = 60.0;
  CHECK(study(request, &RigRun::dps310).sigma_pa == doctest::Approx(0.35).epsilon(0.04).scale(0.0));
  // 2.35 Pa of noise and 0.29 Pa of rounding to 1 Pa.
  CHECK(study(request, &RigRun::ceramic).sigma_pa == doctest::Approx(2.37).epsilon(0.04).scale(0.0));
  CHECK(typical(&RigRun::dps310, 4.0).median_m > 1.3 * typical(&RigRun::dps310, 0.25).median_m);
  const RigRun once = simulation::simulate_rig(request);
  const RigRun again = simulation::simulate_rig(request);
  CHECK(once.ceramic.moved.back().pressure_pa == again.ceramic.moved.back().pressure_pa);
  // 30 cm higher at the end.
  const auto mean = [](const std::vector<PressureSample>& samples, std::size_t begin) {
    double sum = 0.0;
    for (std::size_t i = begin; i < begin + 500; ++i) sum += samples[i].pressure_pa / 500.0;
    return sum;
  };
  const std::size_t last = once.dps310.moved.size() - 501;
  const double moved_pa = mean(once.dps310.moved, last) - mean(once.dps310.moved, 0);
  const double standing_pa = mean(once.dps310.standing, last) - mean(once.dps310.standing, 0);
  CHECK(moved_pa - standing_pa == doctest::Approx(-0.3 / 0.0847).epsilon(0.15).scale(0.0));
}

TEST_CASE("isobar experiment sensitivity writes its report from simulated and from recorded rigs") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  CHECK(sensitivity({"--runs", "2", "--dwell", "10", "--out", path("simulated")}) == 0);
  const std::string html = read_text_file(path("simulated") + "/report.html");
  CHECK(html.find("Ten steps of 3 cm") != std::string::npos);
  CHECK(html.find("Five steps of 13 cm") != std::string::npos);
  CHECK(html.find("Setra 278") != std::string::npos);

  const std::string errors = read_text_file(path("simulated") + "/errors.csv");
  // A header; then 5 and 10 steps of two experiments, for two sensors, raw and filtered, in two runs.
  CHECK(std::count(errors.begin(), errors.end(), '\n') == 1 + (5 + 10) * 2 * 2 * 2);

  write_rig(path("rig"));
  // Steps are found without --segments; with --steps their number must match.
  CHECK(sensitivity({"--recording", path("rig"), "--step", "0.13", "--out", path("found")}) == 0);
  CHECK(read_text_file(path("found") + "/report.html").find("Five steps of 13 cm") != std::string::npos);
  CHECK(sensitivity({"--recording", path("rig") + "/barometer.csv", "--base",
                     path("rig") + "/base_barometer.csv", "--step", "0.13", "--steps", "5", "--sensor",
                     "MEMS", "--out", path("named")}) == 0);
  CHECK(sensitivity({"--recording", path("rig"), "--step", "0.13", "--steps", "30", "--out", path("no")}) ==
        65);
}

TEST_CASE("the levels of a recorded rig can be named, with heights and with words") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const RigRun rig = write_rig(path("rig"));
  // Levels named in segments.csv, with heights and with words as labels.
  const auto segments = [&](bool heights) {
    std::string text = "t_start_ns,t_end_ns,label\n";
    for (std::size_t i = 0; i <= rig.moves_ns.size(); ++i) {
      const std::int64_t begin_ns = i == 0 ? rig.dps310.moved.front().stamp_ns : rig.moves_ns[i - 1];
      const std::int64_t end_ns =
          i < rig.moves_ns.size() ? rig.moves_ns[i] : rig.dps310.moved.back().stamp_ns;
      text += std::to_string(begin_ns + 1'000'000'000) + "," + std::to_string(end_ns - 1'000'000'000) + "," +
              (heights ? std::to_string(0.13 * static_cast<double>(i)) : "level") + "\n";
    }
    return text;
  };
  for (const bool heights : {true, false}) {
    write_text_file(path("rig") + "/segments.csv", segments(heights));
    CHECK(sensitivity({"--recording", path("rig"), "--step", "0.13", "--out", path("levels")}) == 0);
  }
}

TEST_CASE("each mistake of isobar experiment sensitivity has its exit code") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  write_rig(path("rig"));
  // Levels outside the time of the samples.
  write_text_file(path("late.csv"),
                  "t_start_ns,t_end_ns,label\n1800000000000000000,1800000001000000000,0\n"
                  "1800000002000000000,1800000003000000000,0.13\n");
  CHECK(sensitivity({"--recording", path("rig"), "--step", "0.13", "--segments", path("late.csv"), "--out",
                     path("no")}) == 65);
  CHECK(sensitivity({"--recording", path("rig")}) == 64);
  CHECK(sensitivity({"--recording", path("rig") + "/barometer.csv", "--step", "0.13"}) == 64);
  CHECK(sensitivity({"--recording", path("none"), "--step", "0.13"}) == 65);
  CHECK(sensitivity({"--step", "-1"}) == 64);
  // Steps of 3 mm cannot be found.
  CHECK(sensitivity({"--recording", path("rig"), "--step", "0.003", "--out", path("no")}) == 65);
}

}  // namespace isobar::test::test_sensitivity_command
