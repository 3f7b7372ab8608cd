// SPDX-License-Identifier: BSD-3-Clause
// `isobar noise`: what a barometer is worth, from a recording in which it stood still for a while.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/altitude/hypsometry.hpp"
#include "core/calibration/filter_design.hpp"
#include "core/calibration/sensor_noise.hpp"
#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "tools/commands.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/noise_report.hpp"
#include "tools/report/svg.hpp"

namespace isobar::tools {

namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kOfferedLagsS{0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0};

struct NoiseArguments {
  std::filesystem::path file;
  std::string columns;
  double from_s = kUnset;
  double to_s = kUnset;
  double lag_s = kUnset;
  double bandwidth_hz = kUnset;
  double output_sigma_pa = kUnset;
  std::filesystem::path report;
};

/// The samples of the file, and what became of them.
struct Study {
  PressureLog log;
  std::vector<double> times_s;
  std::vector<double> pressures_pa;
  SensorNoise noise;
};

Study study(const NoiseArguments& arguments) {
  Study result;
  result.log = read_new_values(arguments.file, parse_columns(arguments.columns));
  result.times_s = result.log.times_s();
  result.pressures_pa = result.log.pressures_pa();
  const std::span<const double> times(result.times_s);
  const std::span<const double> pressures(result.pressures_pa);
  if (std::isnan(arguments.from_s) && std::isnan(arguments.to_s)) {
    result.noise = study_noise(times, pressures);
    if (result.noise.still.count() == 0) {
      throw DataError(arguments.file.string() +
                      ": the pressure was never still for 10 s; name a span with --from and --to");
    }
  } else {
    const auto at = [&](double time_s) {
      return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time_s) - times.begin());
    };
    const std::size_t begin = std::isnan(arguments.from_s) ? 0 : at(arguments.from_s);
    const std::size_t end = std::isnan(arguments.to_s) ? times.size() : at(arguments.to_s);
    if (end < begin + 10) throw UsageError("--from, --to: fewer than ten samples lie between them");
    result.noise =
        study_still_noise(times.subspan(begin, end - begin), pressures.subspan(begin, end - begin));
    result.noise.still = {begin, end};
  }
  if (!(result.noise.sigma_pa > 0.0)) {
    throw DataError(arguments.file.string() + ": the samples have no noise: the numbers are too coarse");
  }
  return result;
}

FilterDesign chosen_design(const NoiseArguments& arguments, const SensorNoise& noise) {
  if (!std::isnan(arguments.bandwidth_hz)) {
    if (arguments.bandwidth_hz >= 0.5 / noise.interval_s) {
      throw UsageError("--bandwidth: must be below half the sample rate of " +
                       std::to_string(1.0 / noise.interval_s) + " Hz");
    }
    return design_for_bandwidth(noise.sigma_pa, noise.interval_s, arguments.bandwidth_hz);
  }
  if (!std::isnan(arguments.output_sigma_pa)) {
    if (arguments.output_sigma_pa >= noise.sigma_pa) {
      throw UsageError("--noise: the samples are as quiet as that without a filter");
    }
    return design_for_noise(noise.sigma_pa, noise.interval_s, arguments.output_sigma_pa);
  }
  return design_for_lag(noise.sigma_pa, noise.interval_s,
                        std::isnan(arguments.lag_s) ? 1.0 : arguments.lag_s);
}

void print_noise(const Study& study, double cm_per_pa) {
  const SensorNoise& noise = study.noise;
  for (const std::string& note : study.log.notes) std::printf("%s\n", note.c_str());
  std::printf("%zu samples over %.1f s, %.2f Hz\n", study.times_s.size(), study.times_s.back(),
              1.0 / noise.interval_s);
  std::printf("still from %.1f to %.1f s: %zu samples\n\n", study.times_s[noise.still.begin],
              study.times_s[noise.still.end - 1], noise.still.count());
  std::printf("sigma of a sample    %8.4f Pa        %6.2f cm   (second differences)\n", noise.sigma_pa,
              cm_per_pa * noise.sigma_pa);
  std::printf("  by Allan deviation %8.4f Pa        %6.2f cm\n", noise.allan_sigma_pa(),
              cm_per_pa * noise.allan_sigma_pa());
  if (noise.allan_sigma_pa() < 0.7 * noise.sigma_pa) {
    std::printf(
        "  the Allan deviation has less white noise: moving air, or neighbours are not independent; the\n"
        "  sensor's own white noise is at most this\n");
  }
  std::printf("white noise          %8.4f Pa sqrt(s)\n", noise.parts.white);
  std::printf("bias instability     %8.4f Pa        %6.2f cm\n", noise.parts.bias_instability,
              cm_per_pa * noise.parts.bias_instability);
  std::printf("random walk          %8.4f Pa/sqrt(s)\n", noise.parts.walk);
  std::printf("steady trend         %8.1f Pa/h\n\n", 3600.0 * noise.parts.ramp);
  std::printf("   tau [s]  Allan deviation [Pa]     ±     parts [Pa]\n");
  for (const AllanPoint& point : noise.allan) {
    std::printf("%10.3f  %14.5f       %5.0f %%  %11.5f\n", point.tau_s, point.deviation,
                100.0 * point.uncertainty, modelled_deviation(noise.parts, point));
  }
}

void print_designs(const std::vector<FilterDesign>& designs, const FilterDesign& chosen,
                   const SensorNoise& noise, double cm_per_pa) {
  std::printf("\nlow-pass:  lag [s]  bandwidth [Hz]  gain    walk [Pa/sqrt(s)]  noise left [Pa]  [cm]\n");
  for (const FilterDesign& design : designs) {
    std::printf("          %8.2f  %14.3f  %6.4f  %17.4f  %15.4f  %4.2f\n", design.delay_s,
                design.bandwidth_hz, design.gain, design.walk_pa_sqrt_s, design.output_sigma_pa,
                cm_per_pa * design.output_sigma_pa);
  }
  std::printf(
      "\n# a lag of %.2f s, %.3f Hz; a climb of 0.25 m/s is %.0f cm behind before its stamp is corrected\n"
      "[altimeter]\ninitial_noise_pa = %.4f\nbase_walk_pa_sqrt_s = %.5f\n",
      chosen.delay_s, chosen.bandwidth_hz, 25.0 * chosen.delay_s, noise.sigma_pa, chosen.walk_pa_sqrt_s);
}

std::string typed_command(const NoiseArguments& arguments) {
  std::string command = "isobar noise " + arguments.file.string();
  if (!arguments.columns.empty()) command += " --columns " + arguments.columns;
  const auto add = [&](const char* name, double value) {
    if (!std::isnan(value)) command += " " + std::string(name) + " " + report::fixed(value, 3);
  };
  add("--from", arguments.from_s);
  add("--to", arguments.to_s);
  add("--lag", arguments.lag_s);
  add("--bandwidth", arguments.bandwidth_hz);
  add("--noise", arguments.output_sigma_pa);
  return command + " --report " + arguments.report.string();
}

void run(const NoiseArguments& arguments) {
  Study result = study(arguments);
  const SensorNoise& noise = result.noise;
  const double cm_per_pa =
      100.0 * hypsometric_scale_m(20.0 + kZeroCelsiusK) / result.pressures_pa[noise.still.begin];
  std::vector<FilterDesign> designs;
  for (const double lag_s : kOfferedLagsS) {
    if (lag_s >= noise.interval_s) designs.push_back(design_for_lag(noise.sigma_pa, noise.interval_s, lag_s));
  }
  const FilterDesign chosen = chosen_design(arguments, noise);
  print_noise(result, cm_per_pa);
  print_designs(designs, chosen, noise, cm_per_pa);
  if (arguments.report.empty()) return;
  report::NoiseReport page{"Noise of " + arguments.file.filename().string(),
                           std::to_string(noise.still.count()) + " samples at " +
                               report::fixed(1.0 / noise.interval_s, 1) + " Hz, from " +
                               report::fixed(result.times_s[noise.still.begin], 1) + " to " +
                               report::fixed(result.times_s[noise.still.end - 1], 1) + " s.",
                           typed_command(arguments),
                           noise,
                           cm_per_pa,
                           std::move(designs),
                           chosen,
                           std::move(result.times_s),
                           std::move(result.pressures_pa)};
  files::write_text_file(arguments.report, report::render_noise_report(page));
  std::printf("\nreport: %s\n", arguments.report.c_str());
}

}  // namespace

void add_noise_command(CLI::App& app) {
  auto arguments = std::make_shared<NoiseArguments>();
  CLI::App* command = app.add_subcommand(
      "noise", "What a barometer is worth: sigma, Allan deviation, settings of its low-pass");
  command->add_option("FILE", arguments->file, "CSV of one barometer, a recording's or a logger's")
      ->required();
  command->add_option("--columns", arguments->columns, kColumnsHelp);
  command->add_option("--from", arguments->from_s,
                      "the sensor stands still from here [s since the first row]");
  command->add_option("--to", arguments->to_s, "and up to here (default: the longest still period is found)");
  auto* lag = command->add_option("--lag", arguments->lag_s, "allowed lag of the low-pass [s] (default: 1)")
                  ->check(CLI::PositiveNumber);
  auto* bandwidth =
      command
          ->add_option("--bandwidth", arguments->bandwidth_hz, "motion up to this frequency must pass [Hz]")
          ->check(CLI::PositiveNumber)
          ->excludes(lag);
  command
      ->add_option("--noise", arguments->output_sigma_pa,
                   "wanted noise of the output [Pa] (the paper wants 0.1)")
      ->check(CLI::PositiveNumber)
      ->excludes(lag)
      ->excludes(bandwidth);
  command->add_option("--report", arguments->report, "write an HTML report with the plot");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace isobar::tools
