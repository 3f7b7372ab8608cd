// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/barometer_swap.hpp"

#include <algorithm>
#include <cmath>

#include "core/plausibility.hpp"

namespace isobar {

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr int kMeanSeconds = 5;
constexpr int kApartSeconds = 30;
constexpr double kFloorPa = 36.0;
constexpr double kStandsShare = 0.2;
constexpr int kLeastSwappedWindows = 5;

std::optional<double> change_pa(const PressureSeconds& series, std::int64_t second) {
  const auto before = series.mean_pa(second, kMeanSeconds);
  const auto after = series.mean_pa(second + kApartSeconds, kMeanSeconds);
  if (!before || !after) return {};
  return *after - *before;
}

/// One moves by a floor or more, the other stands.
bool only_first_moves(double first_pa, double second_pa) {
  return std::abs(first_pa) >= kFloorPa && std::abs(second_pa) <= kStandsShare * std::abs(first_pa);
}

}  // namespace

void PressureSeconds::add(const PressureSample& sample) {
  if (implausible_stamp(sample.stamp_ns) != nullptr || !kPlausiblePressurePa.holds(sample.pressure_pa))
    return;
  const std::int64_t second = sample.stamp_ns / kSecondNs;
  if (cells_.empty()) first_ = second;
  const std::int64_t index = second - first_;
  if (index < 0 || index >= static_cast<std::int64_t>(kCapacity)) return;
  if (index >= static_cast<std::int64_t>(cells_.size())) cells_.resize(static_cast<std::size_t>(index) + 1);
  Cell& cell = cells_[static_cast<std::size_t>(index)];
  cell.sum_pa += sample.pressure_pa;
  ++cell.samples;
}

std::optional<double> PressureSeconds::mean_pa(std::int64_t second, int count) const {
  if (second < first_ || second + count > end()) return {};
  double sum_pa = 0.0;
  for (int i = 0; i < count; ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(second - first_ + i)];
    if (cell.samples == 0) return {};
    sum_pa += cell.sum_pa / cell.samples;
  }
  return sum_pa / count;
}

std::optional<Finding> find_swapped_barometers(const PressureSeconds& robot, const PressureSeconds& base) {
  int swapped = 0;
  int right = 0;
  double largest_pa = 0.0;
  const std::int64_t end = std::min(robot.end(), base.end());
  for (std::int64_t second = std::max(robot.first(), base.first()); second < end; ++second) {
    const auto robot_pa = change_pa(robot, second);
    const auto base_pa = change_pa(base, second);
    if (!robot_pa || !base_pa) continue;
    right += only_first_moves(*robot_pa, *base_pa) ? 1 : 0;
    if (!only_first_moves(*base_pa, *robot_pa)) continue;
    ++swapped;
    if (std::abs(*base_pa) > std::abs(largest_pa)) largest_pa = *base_pa;
  }
  if (swapped < kLeastSwappedWindows || right > 0) return {};
  return Finding{.kind = Contradiction::kBarometersSwapped,
                 .sensor = CheckedSensor::kBaseBarometer,
                 .other = CheckedSensor::kBarometer,
                 .measured = largest_pa,
                 .confidence = 1.0,
                 .evidence = static_cast<double>(swapped)};
}

}  // namespace isobar
