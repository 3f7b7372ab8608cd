// SPDX-License-Identifier: BSD-3-Clause
#include "core/contradictions/motion_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <span>

namespace isobar {

namespace {

constexpr int kWindowCells = 10;
// 2 deg in a second: noise of scans and of wheels is a tenth of it.
constexpr double kLeastTurnRad = 0.04;
// A way that scans measure to a tenth, and a turn in which a lever arm that is wrong by 0.1 m moves by less than a third of it.
constexpr double kLeastWayM = 0.1;
constexpr double kMostTurnRad = 0.3;
// Change of speed in a second that stands out from vibration and bumps.
constexpr double kLeastChangeMS = 0.15;
constexpr int kLeastChanges = 8;

double correlation_of(double product, double square_a, double square_b) {
  return square_a > 0.0 && square_b > 0.0 ? product / std::sqrt(square_a * square_b) : 0.0;
}

}  // namespace

TurnRatio compare_turns(const MotionSeries& sensor, const MotionSeries& reference) {
  TurnRatio out;
  double product = 0.0;
  double sensor2 = 0.0;
  double reference2 = 0.0;
  const std::int64_t end = std::min(sensor.end(), reference.end());
  for (std::int64_t cell = std::max(sensor.first(), reference.first()); cell + kWindowCells <= end;
       cell += kWindowCells) {
    const PlanarSum a = sensor.sum(cell, kWindowCells);
    const PlanarSum b = reference.sum(cell, kWindowCells);
    if (!a.turn_known || !b.turn_known || std::abs(b.step.turn_rad) < kLeastTurnRad) continue;
    product += a.step.turn_rad * b.step.turn_rad;
    sensor2 += a.step.turn_rad * a.step.turn_rad;
    reference2 += b.step.turn_rad * b.step.turn_rad;
    out.turned_rad += std::abs(b.step.turn_rad);
    ++out.windows;
  }
  out.correlation = correlation_of(product, sensor2, reference2);
  if (reference2 > 0.0) out.ratio = std::copysign(std::sqrt(sensor2 / reference2), product);
  return out;
}

WayRatio compare_ways(const MotionSeries& wheels, const MotionSeries& scans) {
  WayRatio out;
  std::complex<double> product;
  double wheels2 = 0.0;
  double scans2 = 0.0;
  const std::int64_t end = std::min(wheels.end(), scans.end());
  for (std::int64_t cell = std::max(wheels.first(), scans.first()); cell + kWindowCells <= end;
       cell += kWindowCells) {
    const PlanarSum w = wheels.sum(cell, kWindowCells);
    const PlanarSum s = scans.sum(cell, kWindowCells);
    if (!w.way_known || !s.way_known || !s.turn_known || std::abs(s.step.turn_rad) > kMostTurnRad) continue;
    const std::complex<double> by_wheels(w.step.x_m, w.step.y_m);
    const std::complex<double> by_scans(s.step.x_m, s.step.y_m);
    if (std::abs(by_scans) < kLeastWayM) continue;
    product += std::conj(by_wheels) * by_scans;
    wheels2 += std::norm(by_wheels);
    scans2 += std::norm(by_scans);
    out.way_m += std::abs(by_scans);
    ++out.windows;
  }
  out.correlation = correlation_of(std::abs(product), wheels2, scans2);
  out.angle_rad = std::arg(product);
  if (scans2 > 0.0) out.ratio = std::sqrt(wheels2 / scans2);
  return out;
}

std::optional<double> compare_accelerations(const MotionSeries& accelerometer, const MotionSeries& wheels) {
  constexpr int kMeanCells = 50;  // either side
  double product = 0.0;
  double felt2 = 0.0;
  double rolled2 = 0.0;
  int changes = 0;
  const std::int64_t end = std::min(accelerometer.end(), wheels.end());
  for (std::int64_t cell = std::max(accelerometer.first(), wheels.first());
       cell + std::int64_t{2} * kWindowCells <= end; cell += kWindowCells) {
    const PlanarSum before = wheels.sum(cell, kWindowCells);
    const PlanarSum after = wheels.sum(cell + kWindowCells, kWindowCells);
    // Between the middles of both seconds, where the accelerometer's change is summed.
    const std::int64_t from = cell + kWindowCells / 2;
    const PlanarSum felt = accelerometer.sum(from, kWindowCells);
    const PlanarSum mean = accelerometer.sum(from + kWindowCells / 2 - kMeanCells, 2 * kMeanCells);
    if (!before.way_known || !after.way_known || !felt.way_known || !mean.way_known) continue;
    const double rolled_m_s = after.step.x_m - before.step.x_m;
    if (std::abs(rolled_m_s) < kLeastChangeMS) continue;
    const double felt_m_s = felt.step.x_m - mean.step.x_m * kWindowCells / (2.0 * kMeanCells);
    product += felt_m_s * rolled_m_s;
    felt2 += felt_m_s * felt_m_s;
    rolled2 += rolled_m_s * rolled_m_s;
    ++changes;
  }
  if (changes < kLeastChanges) return {};
  return correlation_of(product, felt2, rolled2);
}

namespace {

constexpr std::int64_t kSearchCells = 600;
constexpr std::int64_t kZeroCells = 3;
constexpr double kPeakShare = 0.5;

/// Turns of all known cells: their squares and their sum without sign.
struct TurnEnergy {
  double square = 0.0;
  double turned_rad = 0.0;
};

TurnEnergy energy_of(const MotionSeries& series) {
  TurnEnergy energy;
  for (std::int64_t cell = series.first(); cell < series.end(); ++cell) {
    if (!series.turn_known(cell)) continue;
    const double turn_rad = series.turn_rad(cell);
    energy.square += turn_rad * turn_rad;
    energy.turned_rad += std::abs(turn_rad);
  }
  return energy;
}

double product_at(const MotionSeries& sensor, const MotionSeries& reference, std::int64_t lag) {
  double sum = 0.0;
  const std::int64_t end = std::min(reference.end(), sensor.end() - lag);
  for (std::int64_t cell = std::max(reference.first(), sensor.first() - lag); cell < end; ++cell) {
    if (sensor.turn_known(cell + lag) && reference.turn_known(cell)) {
      sum += sensor.turn_rad(cell + lag) * reference.turn_rad(cell);
    }
  }
  return sum;
}

/// The largest value beside the peak at `peak`, which reaches to where the values fall below half of it on either side.
double best_outside_peak(std::span<const double> at, std::int64_t peak) {
  const auto size = static_cast<std::int64_t>(at.size());
  if (peak < 0 || peak >= size) return 0.0;
  const auto value = [&at](std::int64_t i) { return at[static_cast<std::size_t>(i)]; };
  std::int64_t begin = peak;
  std::int64_t end = peak;
  while (begin >= 0 && value(begin) >= kPeakShare * value(peak)) --begin;
  while (end < size && value(end) >= kPeakShare * value(peak)) ++end;
  double best = 0.0;
  for (std::int64_t i = 0; i < size; ++i) {
    if (i <= begin || i >= end) best = std::max(best, value(i));
  }
  return best;
}

}  // namespace

TurnLag find_turn_lag(const MotionSeries& sensor, const MotionSeries& reference, std::int64_t centre_cells) {
  TurnLag out;
  const TurnEnergy a = energy_of(sensor);
  const TurnEnergy b = energy_of(reference);
  out.turned_rad = std::min(a.turned_rad, b.turned_rad);
  if (!(a.square > 0.0) || !(b.square > 0.0)) return out;
  // By the energy of both whole streams: a short overlap cannot look good.
  const double scale = 1.0 / std::sqrt(a.square * b.square);
  std::array<double, 2 * kSearchCells + 1> at{};
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(at.size()); ++i) {
    const std::int64_t lag = centre_cells + i - kSearchCells;
    const double correlation = scale * product_at(sensor, reference, lag);
    at[static_cast<std::size_t>(i)] = correlation;
    if (correlation <= out.correlation) continue;
    out.correlation = correlation;
    out.lag_cells = lag;
  }
  out.second = best_outside_peak(at, out.lag_cells - centre_cells + kSearchCells);
  for (std::int64_t lag = -kZeroCells; lag <= kZeroCells; ++lag) {
    out.at_zero = std::max(out.at_zero, scale * product_at(sensor, reference, lag));
  }
  return out;
}

}  // namespace isobar
