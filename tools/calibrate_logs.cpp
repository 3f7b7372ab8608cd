// SPDX-License-Identifier: BSD-3-Clause
#include "tools/calibrate_logs.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <system_error>
#include <utility>

#include "core/calibration/calibration_pairs.hpp"
#include "core/errors.hpp"
#include "core/statistics/distribution.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::tools {

namespace {

using recording::PressureLog;
using report::fixed;

// 50 hPa, some 400 m: sensor and reference are in different places, or one is in another unit.
constexpr double kMaxSamePlacePa = 5'000.0;
// Correlation of pressure changes above which even the noise is equal: the logs are of one sensor.
constexpr double kSameSensorCorrelation = 0.99999;

std::vector<PressureLog> read_all(const LogSelection& selection, const char* role,
                                  std::vector<std::string>& notes) {
  std::vector<PressureLog> logs;
  for (const std::filesystem::path& file : selection.files) {
    logs.push_back(recording::read_pressure_log(file, selection.columns));
    std::string line = std::string(role) + " " + logs.back().file + ": " +
                       std::to_string(logs.back().samples.size()) + " rows";
    for (const std::string& note : logs.back().notes) line += "; " + note;
    notes.push_back(std::move(line));
  }
  return logs;
}

bool is_same_file(const LogSelection& a, const LogSelection& b) {
  std::error_code ignored;
  return std::any_of(a.files.begin(), a.files.end(), [&](const auto& file) {
    return std::any_of(b.files.begin(), b.files.end(),
                       [&](const auto& other) { return std::filesystem::equivalent(file, other, ignored); });
  });
}

PressureSeries series_of(std::span<const PressureLog> logs) {
  std::vector<std::int64_t> stamps_ns;
  std::vector<double> pressures_pa;
  for (const PressureLog& log : logs) {
    for (const PressureSample& sample : log.samples) {
      stamps_ns.push_back(sample.stamp_ns);
      pressures_pa.push_back(sample.pressure_pa);
    }
  }
  return {stamps_ns, std::move(pressures_pa)};
}

void put_in_order(std::vector<PressureLog>& logs) {
  std::sort(logs.begin(), logs.end(), [](const PressureLog& a, const PressureLog& b) {
    return a.samples.front().stamp_ns < b.samples.front().stamp_ns;
  });
  for (std::size_t k = 1; k < logs.size(); ++k) {
    if (logs[k].samples.front().stamp_ns <= logs[k - 1].samples.back().stamp_ns) {
      throw DataError(logs[k].file + ": begins before " + logs[k - 1].file +
                      " ends; for references of different sensor logs use --paired");
    }
  }
}

double median_pa(std::span<const PressureLog> logs) {
  std::vector<double> values;
  for (const PressureLog& log : logs) {
    for (const PressureSample& sample : log.samples) values.push_back(sample.pressure_pa);
  }
  return median(std::move(values));
}

void require_one_place(std::span<const PressureLog> sensor, std::span<const PressureLog> reference) {
  const double sensor_pa = median_pa(sensor);
  const double reference_pa = median_pa(reference);
  if (std::abs(sensor_pa - reference_pa) <= kMaxSamePlacePa) return;
  throw DataError(sensor.front().file + ": median pressure " + fixed(0.01 * sensor_pa, 1) +
                  " hPa, the reference's " + fixed(0.01 * reference_pa, 1) +
                  " hPa: a different place, or a wrong unit");
}

std::string shift_sentence(const ClockShift& shift) {
  const int decimals = shift.scale_s < 20.0 ? 3 : 1;
  std::string text = "the reference's time is the sensor's " +
                     std::string(shift.shift_s < 0.0 ? "- " : "+ ") +
                     fixed(std::abs(shift.shift_s), decimals) + " s +- " + fixed(shift.sigma_s, decimals) +
                     " s: " + std::to_string(shift.changes) + " changes of pressure over " +
                     fixed(shift.scale_s, decimals) + " s then correlate by " + fixed(shift.correlation, 2);
  if (std::isfinite(shift.next_best_shift_s)) {
    text += "; next best " + fixed(shift.next_best_correlation, 2) + " at " +
            fixed(shift.next_best_shift_s, decimals) + " s";
  }
  return text;
}

/// Finds one shift for all sensor logs; notes it.
double find_shift(std::span<const PressureLog> sensor, const PressureSeries& reference,
                  const CalibrationLogs& logs, std::vector<std::string>& notes) {
  if (logs.shift_s) {
    notes.push_back("clocks: the reference's clock is " + fixed(*logs.shift_s, 3) +
                    " s ahead of the sensor's, by --shift");
    return *logs.shift_s;
  }
  if (is_same_file(logs.sensor, logs.reference)) {
    notes.emplace_back("clocks: sensor and reference are in one file and share its clock");
    return 0.0;
  }
  std::vector<PressureSeries> series;
  for (const PressureLog& log : sensor) series.push_back(series_of({&log, 1}));
  const ClockShift shift = find_clock_shift(series, reference, {logs.window_s, 0.0});
  if (!shift.doubt.empty()) {
    throw DataError(sensor.front().file + ": the shift to the reference's clock is ambiguous, " +
                    shift.doubt + (shift.changes > 0 ? " (" + shift_sentence(shift) + ")" : "") +
                    "; give it with --shift (0: equal clocks), or search further with --window");
  }
  if (shift.correlation > kSameSensorCorrelation) {
    throw DataError(sensor.front().file + ": the reference is the sensor itself: even their noise is equal");
  }
  notes.push_back("clocks: " + shift_sentence(shift));
  return shift.shift_s;
}

void pair(std::span<const PressureLog> sensor, std::span<const PressureLog> reference,
          const CalibrationLogs& logs, AlignedLogs& aligned) {
  require_one_place(sensor, reference);
  const PressureSeries series = series_of(reference);
  const double shift_s = find_shift(sensor, series, logs, aligned.notes);
  for (const PressureLog& log : sensor) {
    PairingCounts counts;
    aligned.recordings.push_back({log.file, pair_with_reference(log.samples, series, shift_s, counts)});
    aligned.has_temperature = aligned.has_temperature || log.has_temperature;
    const auto say = [&](std::size_t count, const char* what) {
      if (count > 0) aligned.notes.push_back(log.file + ": " + what + ": " + std::to_string(count));
    };
    say(counts.without_reference, "rows left out, no reference at their time");
    say(counts.without_temperature, "rows left out, no temperature");
  }
}

}  // namespace

AlignedLogs align_logs(const CalibrationLogs& logs) {
  const bool same_columns = logs.sensor.columns.pressure == logs.reference.columns.pressure;
  if (is_same_file(logs.sensor, logs.reference) && same_columns) {
    throw DataError("the reference is the sensor itself: the same column of the same file");
  }
  if (logs.paired && logs.sensor.files.size() != logs.reference.files.size()) {
    throw UsageError("--paired: there are " + std::to_string(logs.sensor.files.size()) + " sensor logs and " +
                     std::to_string(logs.reference.files.size()) + " reference logs");
  }
  AlignedLogs aligned;
  const std::vector<recording::PressureLog> sensor = read_all(logs.sensor, "sensor", aligned.notes);
  std::vector<recording::PressureLog> reference = read_all(logs.reference, "reference", aligned.notes);
  if (logs.paired) {
    for (std::size_t k = 0; k < sensor.size(); ++k) pair({&sensor[k], 1}, {&reference[k], 1}, logs, aligned);
  } else {
    put_in_order(reference);
    pair(sensor, reference, logs, aligned);
  }
  if (const std::size_t spikes = drop_spikes(aligned.recordings); spikes > 0) {
    aligned.warnings.push_back(std::to_string(spikes) +
                               " samples left out: spikes of the sensor or the reference");
  }
  return aligned;
}

}  // namespace isobar::tools
