// SPDX-License-Identifier: BSD-3-Clause
#include "run/merge/height_relation.hpp"

#include <cmath>

#include "core/altitude/hypsometry.hpp"

namespace isobar::files {

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

}  // namespace isobar::files
