// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pressure_log.hpp"

#include <CLI/CLI.hpp>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/stamp.hpp"
#include "run/recording/base_clock.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

/// Removes ":UNIT" from a column's name and returns UNIT; empty without one.
std::string take_unit(std::string& name) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos) return {};
  std::string unit = name.substr(colon + 1);
  name.resize(colon);
  return unit;
}

}  // namespace

recording::PressureColumns parse_columns(const std::string& text) {
  recording::PressureColumns columns;
  if (text.empty()) return columns;
  std::vector<std::string> names = comma_separated(text);
  if (names.size() < 2 || names.size() > 3) {
    throw UsageError("--columns: \"" + text + "\": must be TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE]");
  }
  columns.time_unit = take_unit(names[0]);
  columns.pressure_unit = take_unit(names[1]);
  columns.time = names[0];
  columns.pressure = names[1];
  columns.needs_temperature = names.size() > 2;
  if (columns.needs_temperature) columns.temperature = names[2];
  return columns;
}

void add_air_option(CLI::App& command, std::optional<double>& air_c) {
  command.add_option("--air", air_c, "air temperature [degC] (default: the coldest sensor's)")
      ->check(CLI::Range(-60.0, 60.0));
}

PressureLog read_new_values(const std::filesystem::path& file, const recording::PressureColumns& columns) {
  recording::PressureLog read = recording::read_pressure_log(file, columns);
  PressureLog log;
  log.notes = std::move(read.notes);
  for (const PressureSample& sample : read.samples) {
    if (!log.samples.empty() && sample.pressure_pa == log.samples.back().pressure_pa) {
      ++log.repeats;
    } else {
      log.samples.push_back(sample);
    }
  }
  if (log.repeats > 0) {
    log.notes.push_back("rows left out because they repeat the value before: " + std::to_string(log.repeats));
  }
  return log;
}

std::vector<double> PressureLog::times_s() const {
  std::vector<double> times;
  times.reserve(samples.size());
  for (const PressureSample& sample : samples) {
    times.push_back(seconds_between(samples.front().stamp_ns, sample.stamp_ns));
  }
  return times;
}

std::vector<double> PressureLog::pressures_pa() const {
  std::vector<double> pressures;
  pressures.reserve(samples.size());
  for (const PressureSample& sample : samples) pressures.push_back(sample.pressure_pa);
  return pressures;
}

std::string tie_clocks(const PressureLog& moved, PressureLog& standing) {
  const auto span = [](const PressureLog& log) {
    return recording::StampSpan{log.samples.front().stamp_ns, log.samples.back().stamp_ns};
  };
  const recording::BaseClock clock = recording::tie_base_clock(span(moved), span(standing));
  for (PressureSample& sample : standing.samples) sample.stamp_ns += clock.offset_ns;
  return clock.reason;
}

std::optional<double> coldest_c(std::initializer_list<const std::vector<PressureSample>*> logs) {
  std::optional<double> coldest;
  for (const std::vector<PressureSample>* log : logs) {
    double sum_c = 0.0;
    double count = 0.0;
    for (const PressureSample& sample : *log) {
      if (!kPlausibleTemperatureC.holds(sample.temperature_c)) continue;
      sum_c += sample.temperature_c;
      count += 1.0;
    }
    if (count > 0.0 && (!coldest || sum_c / count < *coldest)) coldest = sum_c / count;
  }
  return coldest;
}

}  // namespace isobar::tools
