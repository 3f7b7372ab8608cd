// SPDX-License-Identifier: BSD-3-Clause
// `isobar noise`: noise of a barometer from a log with a period at rest.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/calibration/filter_design.hpp"
#include "core/calibration/sensor_noise.hpp"
#include "core/errors.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/output_option.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/noise_report.hpp"
#include "tools/report/number_text.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

constexpr std::array kOfferedLagsS{0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0};
constexpr double kDefaultLagS = 1.0;
constexpr std::size_t kMinStillSamples = 10;  // for a noise estimate
constexpr double kWhiteNoiseAgreement = 0.7;  // least ratio at which the two estimates of white noise agree
constexpr double kClimbCmPerS = 25.0;         // example that shows what a lag costs

struct NoiseArguments {
  std::filesystem::path file;
  std::string columns;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::optional<double> lag_s;
  std::optional<double> bandwidth_hz;
  std::optional<double> output_sigma_pa;
  std::filesystem::path report;
};

/// The samples of a log and their noise.
struct Study {
  PressureLog log;
  std::vector<double> times_s;
  std::vector<double> pressures_pa;
  SensorNoise noise;
};

/// Noise over the period that the command line names.
SensorNoise noise_between(const NoiseArguments& arguments, std::span<const double> times_s,
                          std::span<const double> pressures_pa) {
  const auto at = [&](double time_s) {
    return static_cast<std::size_t>(std::lower_bound(times_s.begin(), times_s.end(), time_s) -
                                    times_s.begin());
  };
  const std::size_t begin = arguments.from_s ? at(*arguments.from_s) : 0;
  const std::size_t end = arguments.to_s ? at(*arguments.to_s) : times_s.size();
  if (end < begin + kMinStillSamples)
    throw UsageError("--from, --to: fewer than ten samples lie between them");
  SensorNoise noise =
      study_still_noise(times_s.subspan(begin, end - begin), pressures_pa.subspan(begin, end - begin));
  noise.still = {begin, end};
  return noise;
}

Study study(const NoiseArguments& arguments) {
  Study result;
  result.log = read_new_values(arguments.file, parse_columns(arguments.columns));
  result.times_s = result.log.times_s();
  result.pressures_pa = result.log.pressures_pa();
  const bool is_named = arguments.from_s || arguments.to_s;
  result.noise = is_named ? noise_between(arguments, result.times_s, result.pressures_pa)
                          : study_noise(result.times_s, result.pressures_pa);
  if (result.noise.still.count() == 0) {
    throw DataError(arguments.file.string() +
                    ": no period of 10 s with still pressure; name one with --from and --to");
  }
  if (!(result.noise.sigma_pa > 0.0)) {
    throw DataError(arguments.file.string() + ": the samples have no noise: their resolution is too coarse");
  }
  return result;
}

FilterDesign chosen_design(const NoiseArguments& arguments, const SensorNoise& noise) {
  if (arguments.bandwidth_hz) {
    if (*arguments.bandwidth_hz >= 0.5 / noise.interval_s) {
      throw UsageError("--bandwidth: must be below half the sample rate of " +
                       report::fixed(1.0 / noise.interval_s, 2) + " Hz");
    }
    return design_for_bandwidth(noise.sigma_pa, noise.interval_s, *arguments.bandwidth_hz);
  }
  if (arguments.output_sigma_pa) {
    if (*arguments.output_sigma_pa >= noise.sigma_pa) {
      throw UsageError("--noise: must be below the noise of a sample, " + report::fixed(noise.sigma_pa, 4) +
                       " Pa");
    }
    return design_for_noise(noise.sigma_pa, noise.interval_s, *arguments.output_sigma_pa);
  }
  return design_for_lag(noise.sigma_pa, noise.interval_s, arguments.lag_s.value_or(kDefaultLagS));
}

std::vector<FilterDesign> offered_designs(const SensorNoise& noise) {
  std::vector<FilterDesign> designs;
  for (const double lag_s : kOfferedLagsS) {
    if (lag_s >= noise.interval_s) designs.push_back(design_for_lag(noise.sigma_pa, noise.interval_s, lag_s));
  }
  return designs;
}

void print_rows(const std::vector<report::Cells>& rows) {
  std::printf("%s\n", report::aligned_rows(rows).c_str());
}

void print_noise(const Study& study, double cm_per_pa) {
  const SensorNoise& noise = study.noise;
  for (const std::string& note : study.log.notes) std::printf("%s\n", note.c_str());
  std::printf("%zu samples over %.1f s, %.2f Hz\n", study.times_s.size(), study.times_s.back(),
              1.0 / noise.interval_s);
  std::printf("still from %.1f to %.1f s: %zu samples\n\n", study.times_s[noise.still.begin],
              study.times_s[noise.still.end - 1], noise.still.count());
  const auto row = [&](const char* name, double value_pa) {
    return report::Cells{name, report::fixed(value_pa, 4), "Pa", report::fixed(cm_per_pa * value_pa, 2),
                         "cm"};
  };
  print_rows({row("sigma of a sample, by second differences", noise.sigma_pa),
              row("sigma of a sample, by Allan deviation", noise.allan_sigma_pa()),
              row("bias instability", noise.parts.bias_instability),
              {"white noise", report::fixed(noise.parts.white, 4), "Pa sqrt(s)"},
              {"random walk", report::fixed(noise.parts.walk, 4), "Pa/sqrt(s)"},
              {"trend", report::fixed(3600.0 * noise.parts.ramp, 1), "Pa/h"}});
  if (noise.allan_sigma_pa() < kWhiteNoiseAgreement * noise.sigma_pa) {
    std::printf(
        "The Allan deviation has less white noise than the second differences: the air moves, or "
        "neighbouring\n"
        "samples are correlated. The sensor's own white noise is at most the smaller value.\n\n");
  }
}

void print_allan_deviation(const SensorNoise& noise) {
  std::vector<report::Cells> rows{{"tau [s]", "Allan deviation [Pa]", "+-", "model [Pa]"}};
  for (const AllanPoint& point : noise.allan) {
    rows.push_back({report::fixed(point.tau_s, 3), report::fixed(point.deviation, 5),
                    report::fixed(100.0 * point.uncertainty, 0) + " %",
                    report::fixed(modelled_deviation(noise.parts, point), 5)});
  }
  print_rows(rows);
}

void print_designs(const std::vector<FilterDesign>& designs, double cm_per_pa) {
  std::vector<report::Cells> rows{
      {"low-pass: lag [s]", "bandwidth [Hz]", "gain", "walk [Pa/sqrt(s)]", "noise left [Pa]", "[cm]"}};
  for (const FilterDesign& design : designs) {
    rows.push_back({report::fixed(design.delay_s, 2), report::fixed(design.bandwidth_hz, 3),
                    report::fixed(design.gain, 4), report::fixed(design.walk_pa_sqrt_s, 4),
                    report::fixed(design.output_sigma_pa, 4),
                    report::fixed(cm_per_pa * design.output_sigma_pa, 2)});
  }
  print_rows(rows);
}

void print_settings(const FilterDesign& chosen, const SensorNoise& noise) {
  std::printf(
      "# lag %.2f s, bandwidth %.3f Hz; at a climb of 0.25 m/s the output lags %.0f cm before its stamp is "
      "corrected\n"
      "[altimeter]\ninitial_noise_pa = %.4f\nbase_walk_pa_sqrt_s = %.5f\n",
      chosen.delay_s, chosen.bandwidth_hz, kClimbCmPerS * chosen.delay_s, noise.sigma_pa,
      chosen.walk_pa_sqrt_s);
}

std::string source_sentence(const Study& study) {
  const SensorNoise& noise = study.noise;
  return std::to_string(noise.still.count()) + " samples at " + report::fixed(1.0 / noise.interval_s, 1) +
         " Hz, from " + report::fixed(study.times_s[noise.still.begin], 1) + " to " +
         report::fixed(study.times_s[noise.still.end - 1], 1) + " s.";
}

void run_noise(const NoiseArguments& arguments, const std::string& command) {
  Study result = study(arguments);
  const double still_pa = result.pressures_pa[result.noise.still.begin];
  // 10 K of air temperature change metres per pascal by 3 %.
  const double cm_per_pa = 100.0 * hypsometric_scale_m(kDefaultAirC + kZeroCelsiusK) / still_pa;
  const FilterDesign chosen = chosen_design(arguments, result.noise);
  std::vector<FilterDesign> designs = offered_designs(result.noise);
  print_noise(result, cm_per_pa);
  print_allan_deviation(result.noise);
  print_designs(designs, cm_per_pa);
  print_settings(chosen, result.noise);
  if (arguments.report.empty()) return;
  report::NoiseReport page;
  page.title = "Noise of " + arguments.file.filename().string();
  page.source = source_sentence(result);
  page.command = command;
  page.noise = result.noise;
  page.cm_per_pa = cm_per_pa;
  page.designs = std::move(designs);
  page.chosen = chosen;
  page.times_s = std::move(result.times_s);
  page.pressures_pa = std::move(result.pressures_pa);
  std::printf("\n");
  write_output(arguments.report, report::render_noise_report(page));
}

}  // namespace

void add_noise_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<NoiseArguments>(
      app, "noise", "Noise of a barometer: sigma, Allan deviation, settings of its low-pass", run_noise);
  command.add_option("FILE", options.file, "CSV of one barometer, a recording's or a logger's")->required();
  command.add_option("--columns", options.columns, kColumnsHelp);
  command.add_option("--from", options.from_s, "start of a period at rest [s since the first row]");
  command.add_option("--to", options.to_s, "its end (default: the longest still period is found)");
  auto* lag = command.add_option("--lag", options.lag_s, "allowed lag of the low-pass [s] (default: 1)")
                  ->check(number_above_zero());
  auto* bandwidth =
      command.add_option("--bandwidth", options.bandwidth_hz, "motion up to this frequency must pass [Hz]")
          ->check(number_above_zero())
          ->excludes(lag);
  command
      .add_option("--noise", options.output_sigma_pa,
                  "allowed noise of the output [Pa]; the paper asks for 0.1")
      ->check(number_above_zero())
      ->excludes(lag)
      ->excludes(bandwidth);
  command.add_option("--report", options.report, "HTML file for the report; it opens without a network")
      ->check(written_as({".html", ".htm"}));
}

}  // namespace isobar::tools
