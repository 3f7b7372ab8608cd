// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/evaluated_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"

namespace isobar::evaluation {

namespace {

namespace fs = std::filesystem;

// Points kept of a map: enough for every picture of the report.
constexpr std::size_t kMaxMapPoints = 1'500'000;

// Share of poses outside the reference above which a note is given: a pose or two at the start are normal.
constexpr double kNotedShareOutside = 0.005;

std::string repairs_note(const std::string& name, const StampRepairs& repairs) {
  return name + ": " + std::to_string(repairs.backwards) + " poses were out of order and sorted, " +
         std::to_string(repairs.duplicates) + " with a repeated stamp were dropped.";
}

bool needed_repair(const StampRepairs& repairs) { return repairs.backwards + repairs.duplicates > 0; }

std::vector<HeightSigma> sigmas_of(const std::vector<StatusRow>& status) {
  std::vector<HeightSigma> sigmas;
  sigmas.reserve(status.size());
  for (const StatusRow& row : status) sigmas.push_back({row.stamp_ns, row.sd_z_m});
  return sigmas;
}

/// Tells the covariances which poses the run calls registered.
void add_modes(const std::vector<StatusRow>& status, std::vector<PoseCovariance>& covariances) {
  std::unordered_map<std::int64_t, bool> registered;
  for (const StatusRow& row : status)
    registered[row.stamp_ns] = row.mode == kPoseModeNames.name(PoseMode::kRegistered);
  for (PoseCovariance& pose : covariances) {
    const auto found = registered.find(pose.stamp_ns);
    if (found != registered.end()) pose.registered = found->second;
  }
}

std::string cut_note(const std::string& name, const StampRepairs& repairs) {
  return name + ": line " + std::to_string(repairs.cut_line) + ", the last one, is cut and is left out.";
}

RunFolder load_estimate(const fs::path& path) {
  if (fs::is_directory(path)) return read_run_folder(path, kMaxMapPoints);
  return {parse_tum(files::read_text_file(path), path.string()), {}, {}, {}, {}, {}};
}

EvaluatedMethod evaluate_one(const ReferenceData& reference, const EstimateSource& source,
                             const EvaluationOptions& options) {
  RunFolder run = load_estimate(source.path);
  add_modes(run.status, run.covariances);
  EvaluatedMethod method{source.name,
                         {},
                         source.path,
                         std::move(run.status),
                         std::move(run.map.points),
                         std::move(run.notes),
                         std::move(run.mounts)};
  try {
    method.evaluation = evaluate(reference.trajectory, reference.segments, run.trajectory,
                                 sigmas_of(method.status), options, std::move(run.covariances));
  } catch (const DataError& error) {
    throw DataError(source.path.string() + ": " + error.what());
  }
  const Eigen::Isometry3f transform = method.evaluation.T_reference_estimate.cast<float>();
  for (auto& point : method.map_points)
    Eigen::Map<Eigen::Vector3f>(point.data()) = transform * Eigen::Vector3f(point.data());
  if (reference.surfaces) method.evaluation.figures.map = map_figures(method.map_points, *reference.surfaces);
  return method;
}

/// A reference whose poses are usually further apart than kUsualGapS.
void add_gap_note(EvaluatedRun& run) {
  const double interval_s = typical_interval_s(run.reference.trajectory);
  if (interval_s <= kUsualGapS) return;
  char text[112];
  std::snprintf(text, sizeof text, "The reference has one pose in %.2g s, more than the usual %.1f s apart.",
                interval_s, kUsualGapS);
  run.notes.emplace_back(text);
}

void add_notes(EvaluatedRun& run) {
  run.notes = run.reference.notes;
  if (std::any_of(run.methods.begin(), run.methods.end(),
                  [](const EvaluatedMethod& m) { return m.evaluation.figures.whole_run_as_flat; })) {
    run.notes.emplace_back("No flat segments: the relative error on z is over the whole run.");
  }
  if (std::any_of(run.methods.begin(), run.methods.end(),
                  [](const EvaluatedMethod& m) { return !m.evaluation.figures.reference_attitude; })) {
    run.notes.emplace_back(
        "The reference has no attitude: the yaw of its frame is the one that fits the path best, and angles "
        "are not "
        "compared.");
  }
  add_gap_note(run);
  for (const EvaluatedMethod& method : run.methods) {
    const MethodFigures& figures = method.evaluation.figures;
    if (needed_repair(figures.repairs))
      run.notes.push_back(repairs_note(display_name(method.name), figures.repairs));
    if (figures.repairs.cut_line > 0)
      run.notes.push_back(cut_note(display_name(method.name), figures.repairs));
    for (const std::string& note : method.notes) run.notes.push_back(display_name(method.name) + ": " + note);
    if (!figures.verdict.ok()) {
      run.notes.push_back(display_name(method.name) + ": " + verdict_word(figures.verdict.kind) + ", " +
                          figures.verdict.reason + ".");
    }
    const std::size_t outside = figures.outside;
    if (static_cast<double>(outside) > kNotedShareOutside * static_cast<double>(figures.poses)) {
      run.notes.push_back(display_name(method.name) + ": " + std::to_string(outside) + " of " +
                          std::to_string(figures.poses) +
                          " poses are outside the time of the reference and are left out.");
    }
  }
}

}  // namespace

Trajectory read_estimate(const fs::path& path) {
  const bool is_run = fs::is_directory(path);
  const fs::path file = is_run ? path / files::kTrajectoryFile : path;
  return parse_tum(files::read_text_file(file), file.string());
}

ReferenceData load_reference(const fs::path& path, const std::optional<fs::path>& segments_file) {
  ReferenceData reference;
  const bool is_recording = fs::is_directory(path);
  reference.source = path;
  const fs::path trajectory_file = is_recording ? path / "reference.tum" : path;
  reference.trajectory = parse_tum(files::read_text_file(trajectory_file), trajectory_file.string());
  std::optional<fs::path> file = segments_file;
  if (!file && is_recording && fs::exists(path / "segments.csv")) file = path / "segments.csv";
  if (file) reference.segments = text::read_segments(text::TextLines(*file));
  if (is_recording && fs::exists(path / files::kSurfacesFile)) {
    std::vector<files::SurfaceTriangle> triangles = files::read_stl(path / files::kSurfacesFile);
    if (triangles.size() <= SurfaceIndex::kMaxTriangles) {
      reference.surfaces = std::make_shared<SurfaceIndex>(std::move(triangles));
    } else {
      reference.notes.push_back("The reference has too many surfaces (" + std::to_string(triangles.size()) +
                                " triangles): the accuracy of the map is left out.");
    }
  }
  if (reference.trajectory.repairs.cut_line > 0) {
    reference.notes.push_back(cut_note("The reference", reference.trajectory.repairs));
  }
  if (needed_repair(reference.trajectory.repairs)) {
    reference.notes.push_back(repairs_note("The reference", reference.trajectory.repairs));
  }
  return reference;
}

EvaluatedRun evaluate_methods(ReferenceData reference, std::vector<EstimateSource> estimates,
                              const EvaluationOptions& options) {
  default_names(estimates);
  EvaluatedRun run{std::move(reference), {}, options, {}};
  for (const EstimateSource& source : estimates)
    run.methods.push_back(evaluate_one(run.reference, source, options));
  add_notes(run);
  return run;
}

void default_names(std::vector<EstimateSource>& estimates) {
  for (EstimateSource& estimate : estimates) {
    if (!estimate.name.empty()) continue;
    const fs::path path = estimate.path.has_filename() ? estimate.path : estimate.path.parent_path();
    const bool is_trajectory = path.filename() == "trajectory.tum" && path.has_parent_path();
    estimate.name = is_trajectory ? path.parent_path().filename().string() : path.stem().string();
  }
  std::map<std::string, int> uses;
  for (const EstimateSource& estimate : estimates) ++uses[estimate.name];
  for (EstimateSource& estimate : estimates) {
    if (uses[estimate.name] > 1) estimate.name = estimate.path.string();
  }
}

std::vector<double> floor_levels_m(const EvaluatedRun& run) {
  std::vector<double> levels;
  for (const EvaluatedMethod& method : run.methods) {
    const auto& floors = method.evaluation.figures.floors;
    if (floors.size() <= levels.size()) continue;
    levels.clear();
    for (const FloorHeight& floor : floors) levels.push_back(floor.reference_m);
  }
  return levels;
}

const FloorHeight* floor_at(const EvaluatedMethod& method, double level_m, double floor_gap_m) {
  for (const FloorHeight& floor : method.evaluation.figures.floors) {
    if (std::abs(floor.reference_m - level_m) < floor_gap_m) return &floor;
  }
  return nullptr;
}

void add_corrected(std::vector<EstimateSource>& estimates) {
  default_names(estimates);
  std::vector<EstimateSource> corrected;
  for (const EstimateSource& of_run : estimates) {
    const std::filesystem::path file = of_run.path / files::kCorrectedTrajectoryFile;
    std::error_code error;
    if (std::filesystem::exists(file, error)) corrected.push_back({of_run.name + " corrected", file});
  }
  estimates.insert(estimates.end(), corrected.begin(), corrected.end());
}

std::string display_name(const std::string& method) {
  static constexpr NameTable<Method, 7> kDisplayNames{{{
      {Method::k6Dof, "6-DOF"},
      {Method::k4Dof, "4-DOF"},
      {Method::k3Dof, "3-DOF"},
      {Method::k6DofAltitude, "6-DOF altitude"},
      {Method::kAdaptive, "Adaptive"},
      {Method::k4DofAltitude, "4-DOF altitude"},
      {Method::kOdometry, "Odometry"},
  }}};
  const std::optional<Method> known = kMethodNames.value(method);
  return known ? std::string(kDisplayNames.name(*known)) : method;
}

}  // namespace isobar::evaluation
