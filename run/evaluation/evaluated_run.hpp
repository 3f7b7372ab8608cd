// SPDX-License-Identifier: BSD-3-Clause
// Loads a reference and several runs, and evaluates each run against the reference.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/evaluation/figures.hpp"
#include "run/evaluation/run_folder.hpp"

namespace isobar::evaluation {

/// Reference trajectory and segments.
struct ReferenceData {
  std::filesystem::path source;
  Trajectory trajectory;
  std::vector<Segment> segments;                 ///< may be empty
  std::shared_ptr<const SurfaceIndex> surfaces;  ///< true surfaces, in the reference's frame; null: unknown
  std::vector<std::string> notes;                ///< whole sentences, e.g. about repaired stamps
};

/// Reads a .tum file, or a recording folder with reference.tum and optionally segments.csv and surfaces.stl.
/// @param segments_file read instead of the folder's segments.csv
/// @throws DataError naming the file when it cannot be read or breaks its format
ReferenceData load_reference(const std::filesystem::path& path,
                             const std::optional<std::filesystem::path>& segments_file = std::nullopt);

/// Trajectory of a .tum file, or of the folder of a run.
/// @throws DataError naming the file when it cannot be read or breaks its format
Trajectory read_estimate(const std::filesystem::path& path);

/// Where an estimate is read from.
struct EstimateSource {
  std::string name;            ///< in tables and charts; empty: set by default_names()
  std::filesystem::path path;  ///< a .tum file, or the folder of a run
};

/// One evaluated estimate.
struct EvaluatedMethod {
  std::string name;
  Evaluation evaluation;
  std::filesystem::path source;
  std::vector<StatusRow> status;                 ///< empty for a .tum file
  std::vector<std::array<float, 3>> map_points;  ///< reference frame [m], thinned; empty for a .tum file
  std::vector<std::string> notes{};              ///< what was left out, in sentences
  std::string mounts{};                          ///< mounts.toml of the run; empty without it
};

/// Reference and all evaluated estimates.
struct EvaluatedRun {
  ReferenceData reference;
  std::vector<EvaluatedMethod> methods;
  EvaluationOptions options;
  std::vector<std::string> notes;  ///< the reference's, and one sentence per repair and per missing part
};

/// Evaluates every estimate, in the order given.
/// @throws DataError naming the file when it cannot be read, breaks its format, or shares no time with the
/// reference
EvaluatedRun evaluate_methods(ReferenceData reference, std::vector<EstimateSource> estimates,
                              const EvaluationOptions& options = {});

/// Sets empty names to the name of the folder, or of the file without extension; to the whole path where two
/// names would be equal.
void default_names(std::vector<EstimateSource>& estimates);

/// Adds, behind them all, the corrected trajectory of each folder of a run that has one (files::kCorrectedTrajectoryFile).
void add_corrected(std::vector<EstimateSource>& estimates);

/// A method's name as the paper writes it: "3-DOF" for "3dof". Other names unchanged.
std::string display_name(const std::string& method);

/// Mean heights of the floors in the reference [m], ascending; empty without flat segments.
std::vector<double> floor_levels_m(const EvaluatedRun& run);

/// The method's figures of the floor within `floor_gap_m` of a height; null if the method has no such floor.
const FloorHeight* floor_at(const EvaluatedMethod& method, double level_m, double floor_gap_m);

}  // namespace isobar::evaluation
