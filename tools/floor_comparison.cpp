// SPDX-License-Identifier: BSD-3-Clause
#include "tools/floor_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "run/evaluation/association.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/stored_floors.hpp"
#include "tools/true_floors.hpp"

namespace isobar::tools {

namespace {

constexpr double kSigmaM = 0.1;  // of the height of a registered pose

std::vector<evaluation::PosePair> pairs_of(const evaluation::ReferenceData& reference,
                                           const std::filesystem::path& file) {
  const evaluation::Trajectory estimate = evaluation::parse_tum(files::read_text_file(file), file.string());
  return evaluation::associate(reference.trajectory, estimate);
}

void compare_corrected(const evaluation::ReferenceData& reference, const std::filesystem::path& file,
                       double storey_m, FloorComparison& figures) {
  const std::vector<evaluation::PosePair> pairs = pairs_of(reference, file);
  for (const evaluation::PosePair& pair : pairs) {
    const double climbed_m = pair.estimate.position_m.z() - pairs.front().estimate.position_m.z();
    const double true_m = pair.reference.position_m.z() - pairs.front().reference.position_m.z();
    const double error_m = std::abs(climbed_m - true_m);
    figures.worst_corrected_m = std::max(figures.worst_corrected_m, error_m);
    if (error_m >= 0.5 * storey_m) ++figures.torn;
  }
}

}  // namespace

FloorComparison compare_floors(const evaluation::ReferenceData& reference, const std::filesystem::path& run) {
  FloorComparison figures;
  TrueFloors truth(reference);
  figures.floors = truth.levels_m().size();
  const auto store = FileTileStore::open_to_read(run / files::kMapDirectory);
  const std::filesystem::path trajectory = run / files::kTrajectoryFile;
  const files::StoredFloors found = files::find_stored_floors(*store, files::path_of(trajectory));
  figures.told = found.floors.floors.size();
  for (const evaluation::PosePair& pair : pairs_of(reference, trajectory)) {
    const std::optional<int> number = truth.number_at(pair.reference);
    if (!number) continue;
    ++figures.poses;
    const FloorGuess guess = floor_at(found.floors, pair.estimate.position_m, kSigmaM);
    if (guess.place != FloorPlace::kOnFloor) continue;
    ++figures.known;
    if (guess.floor->number != *number) ++figures.wrong;
  }
  const std::filesystem::path corrected = run / files::kCorrectedTrajectoryFile;
  if (std::filesystem::exists(corrected)) compare_corrected(reference, corrected, truth.storey_m(), figures);
  return figures;
}

void print_floor_comparison(const char* name, const FloorComparison& figures) {
  std::printf(
      "%-14s floors: %zu told of %zu; of %zu poses on a floor %zu with a known one, %zu with a wrong one\n",
      name, figures.told, figures.floors, figures.poses, figures.known, figures.wrong);
  std::printf(
      "%-14s corrected by loops: %zu poses half a storey or more from their height, the worst %.3f m\n", "",
      figures.torn, figures.worst_corrected_m);
}

}  // namespace isobar::tools
