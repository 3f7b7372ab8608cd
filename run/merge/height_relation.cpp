// SPDX-License-Identifier: BSD-3-Clause
#include "run/merge/height_relation.hpp"

#include <cmath>
#include <string>

#include "core/altitude/hypsometry.hpp"
#include "run/files/run_layout.hpp"

namespace isobar::files {

namespace fs = std::filesystem;

namespace {

constexpr double kAirC = 15.0;
// Biases of both altimeters against their maps, 1 sigma.
constexpr double kBiasesM = 0.3;
constexpr double kAirShare = 0.04;
constexpr double kMostM = 1000.0;

}  // namespace

std::optional<HeightRelation> height_relation(const HeightDatum& a, const HeightDatum& b) {
  if (!a.known || !b.known) return std::nullopt;
  for (std::size_t i = 0; i < HeightDatum::kStations; ++i) {
    if (!a.station_known[i] || !b.station_known[i]) continue;
    const double by_stations_m =
        hypsometric_scale_m(kZeroCelsiusK + kAirC) * (a.station_offset_log[i] - b.station_offset_log[i]);
    HeightRelation relation;
    relation.z_a_b_m = by_stations_m - (a.offset_m - b.offset_m);
    relation.sigma_m = std::hypot(kBiasesM, kAirShare * by_stations_m);
    if (std::abs(relation.z_a_b_m) <= kMostM) return relation;
  }
  return std::nullopt;
}

fs::path run_folder_of(const fs::path& map_folder) {
  return fs::absolute(map_folder / "").lexically_normal().parent_path().parent_path();
}

std::optional<Checkpoint> checkpoint_of_map(const fs::path& map_folder) {
  if (auto own = read_checkpoint(map_folder / kCheckpointFile)) return own;
  auto of_run = read_checkpoint(run_folder_of(map_folder) / kCheckpointFile);
  const std::string name = fs::absolute(map_folder / "").lexically_normal().parent_path().filename();
  const bool of_this = of_run && name == name_of_session(kMapDirectory, of_run->session);
  return of_this ? of_run : std::nullopt;
}

}  // namespace isobar::files
