// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sensitivity_recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/altitude/hypsometry.hpp"
#include "core/errors.hpp"
#include "core/stamp.hpp"
#include "run/recording/manifest.hpp"
#include "run/text/number_text.hpp"
#include "run/text/segments.hpp"
#include "tools/pressure_log.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::tools {

namespace {

struct Files {
  std::filesystem::path moved;
  std::filesystem::path standing;
  std::filesystem::path segments;  ///< may be empty
};

Files files_of(const RecordedRigRequest& request) {
  namespace fs = std::filesystem;
  Files files{request.recording, request.base, request.segments};
  if (!fs::exists(files.moved)) throw DataError(files.moved.string() + ": no such file or folder");
  if (fs::is_directory(request.recording)) {
    files.moved = request.recording / "barometer.csv";
    if (files.standing.empty()) files.standing = request.recording / "base_barometer.csv";
    const fs::path segments = request.recording / recording::kSegmentsFile;
    if (files.segments.empty() && fs::exists(segments)) files.segments = segments;
  }
  if (files.standing.empty()) {
    throw UsageError("--base: missing; it names the standing barometer's file");
  }
  return files;
}

BarometerPair read_pair(const RecordedRigRequest& request, const Files& files,
                        std::vector<std::string>& notes) {
  const recording::PressureColumns columns = parse_columns(request.columns);
  PressureLog moved = read_new_values(files.moved, columns);
  PressureLog standing = read_new_values(files.standing, columns);
  for (const auto& [file, log] : {std::pair{&files.moved, &moved}, std::pair{&files.standing, &standing}}) {
    if (log->samples.size() < 100) throw DataError(file->string() + ": fewer than 100 samples");
    for (const std::string& note : log->notes) notes.push_back(file->string() + ": " + note);
  }
  notes.push_back("clocks: " + tie_clocks(moved, standing));
  return {request.sensor, std::move(moved.samples), std::move(standing.samples)};
}

/// The levels in segments.csv. Labels that are all numbers are true heights [m]; otherwise heights follow
/// from the step's height and the measured directions.
std::vector<Plateau> named_plateaus(const std::filesystem::path& file, const BarometerPair& pair,
                                    const StudyOptions& options) {
  auto segments = text::read_segments(text::TextLines(file));
  std::sort(segments.begin(), segments.end(),
            [](const auto& a, const auto& b) { return a.start_ns < b.start_ns; });
  if (segments.size() < 2) throw DataError(file.string() + ": names fewer than two levels");
  std::vector<Plateau> plateaus;
  std::vector<double> middles_s;
  bool heights_known = true;
  for (const text::Segment& segment : segments) {
    const auto seconds = [&](std::int64_t stamp_ns) {
      return seconds_between(pair.moved.front().stamp_ns, stamp_ns);
    };
    double height_m = 0.0;
    heights_known = heights_known && text::parse_number(segment.label, height_m) && std::isfinite(height_m);
    if (!plateaus.empty()) middles_s.push_back(0.5 * (plateaus.back().end_s + seconds(segment.start_ns)));
    plateaus.push_back({seconds(segment.start_ns), seconds(segment.end_ns), height_m});
  }
  if (heights_known) return plateaus;
  const auto between =
      plateaus_between(raw_track(pair, options.air_temperature_k), middles_s, options.step_m, 0.0, 0.0);
  for (std::size_t i = 0; i < plateaus.size(); ++i) plateaus[i].true_height_m = between[i].true_height_m;
  return plateaus;
}

/// Settling time before and after a step [s], whose time is known to some tenths of a second: a share of the
/// time on a level, so that short levels keep most of their samples.
double found_settle_s(const std::vector<double>& step_times_s) {
  if (step_times_s.size() < 2) return 1.5;
  const double dwell_s =
      (step_times_s.back() - step_times_s.front()) / static_cast<double>(step_times_s.size() - 1);
  return std::clamp(0.15 * dwell_s, 0.5, 1.5);
}

/// The levels between steps that are found in the heights.
std::vector<Plateau> found_plateaus(const RecordedRigRequest& request, const BarometerPair& pair,
                                    const StudyOptions& options, std::vector<std::string>& notes) {
  const HeightTrack track = raw_track(pair, options.air_temperature_k);
  StepSearch search;
  search.step_m = options.step_m;
  search.steps = request.steps;
  const FoundSteps found = find_steps(track, search);
  constexpr double kMaxUncertaintyS = 2.0;
  const std::string advice = "; name the levels with --segments (t_start_ns,t_end_ns,label)";
  if (found.uncertainty_s > kMaxUncertaintyS) {
    throw DataError(request.recording.string() + ": steps of " + report::fixed(100.0 * options.step_m, 1) +
                    " cm cannot be found in this noise (their times to " +
                    report::fixed(found.uncertainty_s, 1) + " s)" + advice);
  }
  if (found.times_s.empty() || (request.steps > 0 && found.times_s.size() != request.steps)) {
    throw DataError(request.recording.string() + ": " + std::to_string(found.times_s.size()) +
                    " steps of this height found" + advice);
  }
  std::string note = std::to_string(found.times_s.size()) + " steps found, each to " +
                     report::fixed(found.uncertainty_s, 2) + " s:";
  for (const double time_s : found.times_s) note += " " + report::fixed(time_s, 1);
  notes.push_back(note + " s");
  const double settle_s = request.settle_s.value_or(found_settle_s(found.times_s));
  return plateaus_between(track, found.times_s, options.step_m, settle_s, settle_s);
}

}  // namespace

RecordedRig read_recorded_rig(const RecordedRigRequest& request) {
  RecordedRig rig;
  const Files files = files_of(request);
  rig.pair = read_pair(request, files, rig.notes);
  rig.moved_file = files.moved;
  rig.standing_file = files.standing;
  StudyOptions& options = rig.options;
  options.step_m = request.step_m.value_or(options.step_m);
  options.lag_s = request.lag_s;
  options.settle_s = request.settle_s.value_or(0.0);
  options.air_temperature_k = air_c_of(request.air_c, {&rig.pair.moved, &rig.pair.standing}) + kZeroCelsiusK;
  rig.plateaus = files.segments.empty() ? found_plateaus(request, rig.pair, options, rig.notes)
                                        : shortened(named_plateaus(files.segments, rig.pair, options),
                                                    options.settle_s, options.settle_s);
  return rig;
}

}  // namespace isobar::tools
