// SPDX-License-Identifier: BSD-3-Clause
// Loads a reference and the runs to compare with it, and evaluates them: what `isobar evaluate` and
// `isobar experiment` share.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "run/evaluation/figures.hpp"
#include "run/files/replay_output.hpp"

namespace isobar::report {

struct ReferenceData {
  std::filesystem::path source;
  evaluation::Trajectory trajectory;
  std::vector<evaluation::Segment> segments;  ///< empty: none named
  std::vector<std::string> notes;             ///< whole sentences for the reader, e.g. about repaired stamps
};

/// `path` is a .tum file, or a recording folder, whose reference.tum and, if there is one, segments.csv are
/// read. `segments_file` is read instead of the folder's. Throws DataError.
ReferenceData load_reference(const std::filesystem::path& path,
                             const std::optional<std::filesystem::path>& segments_file = std::nullopt);

/// A .tum file or the folder of a replay.
struct EstimateSource {
  std::string name;  ///< in tables and charts; empty: made from the path by default_names()
  std::filesystem::path path;
};

struct EvaluatedMethod {
  std::string name;
  std::filesystem::path source;
  evaluation::Evaluation evaluation;
  std::vector<files::StatusRow> status;  ///< empty for a .tum file
  std::vector<std::array<float, 3>>
      map_points;  ///< in the reference's frame [m]; thinned; empty for a .tum file
  std::uint64_t map_points_total = 0;
};

struct EvaluatedRun {
  ReferenceData reference;
  std::vector<EvaluatedMethod> methods;
  evaluation::EvaluationOptions options;
  std::vector<std::string> notes;  ///< the reference's and one for each thing that was repaired or is missing
};

/// Evaluates every estimate, in the order given. Throws DataError naming the file that breaks a rule.
EvaluatedRun evaluate_methods(ReferenceData reference, std::vector<EstimateSource> estimates,
                              const evaluation::EvaluationOptions& options = {});

/// Fills in empty names: the folder's name or the file's without ending; the path where those are not unique.
void default_names(std::vector<EstimateSource>& estimates);

/// "3dof" as the paper writes it: "3-DOF"; other names as they are.
std::string display_name(const std::string& method);

/// Mean heights of the floors in the reference [m], lowest first; empty without flat segments.
std::vector<double> floor_levels_m(const EvaluatedRun& run);

/// The method's figures of the floor within `floor_gap_m` of that height; null if it never was there.
const evaluation::FloorHeight* floor_at(const EvaluatedMethod& method, double level_m, double floor_gap_m);

/// The main figures with their units, one method a row, and the height of each floor.
void print_table(std::FILE* out, const EvaluatedRun& run);

/// Every figure as JSON: {"reference": …, "methods": [{"name": …, "z_rpe_median": …}]}; null where unknown.
/// Lengths in metres, angles in degrees, shares as 0 … 1.
std::string figures_json(const EvaluatedRun& run);

}  // namespace isobar::report
