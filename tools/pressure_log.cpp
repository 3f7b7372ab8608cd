// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pressure_log.hpp"
#include "tools/number_option.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/stamp.hpp"
#include "core/statistics/distribution.hpp"
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

// Rows farther apart are no polls: barometers convert at least so often [s].
constexpr double kSlowestPollS = 5.0;
// A step of the values [Pa] below which two are the same but for rounding in the conversion of units.
constexpr double kSameValuePa = 1e-6;
// The median change of a value, in steps of its resolution, from which on equal values are rare.
constexpr double kFineSteps = 4.0;

/// True when equal successive values are one measurement, read twice: the values are finer than their changes, so that two
/// measurements would hardly be equal. Of a coarse sensor they are two.
bool repeats_are_polls(const std::vector<PressureSample>& samples) {
  if (samples.size() < 2) return false;
  const double length_s = seconds_between(samples.front().stamp_ns, samples.back().stamp_ns);
  if (length_s > kSlowestPollS * static_cast<double>(samples.size() - 1)) return false;
  std::vector<double> changes_pa;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double change_pa = std::abs(samples[k].pressure_pa - samples[k - 1].pressure_pa);
    if (change_pa > kSameValuePa) changes_pa.push_back(change_pa);
  }
  if (changes_pa.empty()) return false;
  const double resolution_pa = *std::min_element(changes_pa.begin(), changes_pa.end());
  return median(std::move(changes_pa)) >= kFineSteps * resolution_pa;
}

}  // namespace

recording::PressureColumns parse_columns(const std::string& text) {
  recording::PressureColumns columns;
  if (text.empty()) return columns;
  std::vector<std::string> names = comma_separated(text);
  if (names.size() < 2 || names.size() > 3) {
    throw UsageError("--columns: \"" + text + "\": must be TIME[:UNIT],PRESSURE[:UNIT][,TEMPERATURE[:UNIT]]");
  }
  columns.time_unit = take_unit(names[0]);
  columns.pressure_unit = take_unit(names[1]);
  columns.time = names[0];
  columns.pressure = names[1];
  columns.needs_temperature = names.size() > 2;
  if (columns.needs_temperature) {
    columns.temperature_unit = take_unit(names[2]);
    columns.temperature = names[2];
  }
  return columns;
}

void add_air_option(CLI::App& command, std::optional<double>& air_c) {
  command.add_option("--air", air_c, "air temperature [degC] (default: the coldest sensor's)")
      ->check(number_within(-60.0, 60.0));
}

PressureLog read_new_values(const std::filesystem::path& file, const recording::PressureColumns& columns) {
  recording::PressureLog read = recording::read_pressure_log(file, columns);
  PressureLog log;
  log.notes = std::move(read.notes);
  const bool polled = repeats_are_polls(read.samples);
  for (const PressureSample& sample : read.samples) {
    const bool repeats = !log.samples.empty() && sample.pressure_pa == log.samples.back().pressure_pa;
    if (repeats && polled) {
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
  const recording::BaseClock clock =
      recording::tie_base_clock(span(moved), span(standing), recording::Recorders::kApart);
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

double air_c_of(const std::optional<double>& chosen_c,
                std::initializer_list<const std::vector<PressureSample>*> logs) {
  if (chosen_c) return *chosen_c;
  const double air_c = coldest_c(logs).value_or(kDefaultAirC);
  if (air_c <= kHottestAirC) return air_c;
  std::array<char, 192> text{};
  std::snprintf(text.data(), text.size(),
                "the thermometer's mean, %.1f degC, is not the air's: the sun or its board heats the sensor, "
                "or it is in "
                "another unit; give the air's with --air",
                air_c);
  throw DataError(text.data());
}

}  // namespace isobar::tools
