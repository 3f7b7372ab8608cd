// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/level_plane.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/geometry.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Histogram of heights: from -kHighestM to kHighestM in bins of kBinM. 4 m hold a storey around the robot.
constexpr double kHighestM = 4.0;
constexpr double kBinM = 0.1;
constexpr std::size_t kBins = 80;
// Points near the robot for the histogram [m]: 2 deg of tilt are 0.2 m at its rim.
constexpr float kNearM = 6.0F;
// Radii of the fits, growing [m]: each tilt is good enough for the next radius.
constexpr std::array<float, 3> kRadiiM{4.0F, 8.0F, 16.0F};
// Distance from the plane of points that belong to it [m], and of one fit's first iteration, at 3 deg of tilt.
constexpr double kBandM = 0.06;
constexpr double kFirstBandM = 0.12;
// Least points of a plane, and least factor of their density over that of the bands beside: walls alone have the same
// density at all heights.
constexpr int kLeastPoints = 80;
constexpr double kLeastContrast = 3.0;
// Share of the points from which on a laser counts for kLeastLevelRings.
constexpr double kLeastRingShare = 0.05;
// Scale of the robust weights (Cauchy) [m]. Noise of a point across the plane [m]; of neighbouring points this share is independent.
constexpr double kRobustM = 0.02;
constexpr double kPointSigmaM = 0.02;
constexpr double kIndependentShare = 0.25;
// Steepest plane that counts as a level one [rad].
constexpr double kSteepestRad = 5.0 * kRadPerDeg;
// Heights that are tried: some peaks are walls. Least distance between the two planes [m].
constexpr int kMostAttempts = 6;
constexpr double kApartM = 1.0;
// Least points of the second plane, as a share of the first's: a ceiling is no smaller than that, ledges of walls are.
constexpr double kLeastSecondShare = 0.1;

// Normal equations of the points within `band_m` of `plane` and `radius_m` of the robot.
struct Fit {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int in_band = 0;
  std::array<int, 256> rings{};  // of the points in the band
  int beside = 0;                // in the two bands of equal width above and below
};

Fit collect(std::span<const LevelPoint> p_level, const LevelPlane& plane, float radius_m, double band_m) {
  Fit fit;
  for (const LevelPoint& point : p_level) {
    const Eigen::Vector3f& p = point.p_m;
    if (p.head<2>().squaredNorm() > radius_m * radius_m) continue;
    const double distance_m = std::abs(plane.distance_m(p));
    if (distance_m > 3.0 * band_m) continue;
    if (distance_m > band_m) {
      ++fit.beside;
      continue;
    }
    const Eigen::Vector3d row(p.x(), p.y(), 1.0);
    const double weight = 1.0 / (1.0 + squared(distance_m / kRobustM));
    fit.A += weight * row * row.transpose();
    fit.b += weight * p.z() * row;
    ++fit.in_band;
    ++fit.rings.at(point.ring);
  }
  return fit;
}

// A direction in which all points lie on one line leaves A singular: its slope stays near 0 by this ridge.
Eigen::Matrix3d regular(const Eigen::Matrix3d& A) {
  Eigen::Matrix3d sum = A;
  sum.diagonal().head<2>().array() += 1.0;
  return sum;
}

int rings_of(const Fit& fit) {
  const double least = kLeastRingShare * fit.in_band;
  return static_cast<int>(
      std::count_if(fit.rings.begin(), fit.rings.end(), [&](int n) { return n > least; }));
}

std::optional<LevelPlane> fit_plane(std::span<const LevelPoint> p_level, double height_m) {
  LevelPlane plane;
  plane.slope_and_height_m.z() = height_m;
  for (const float radius_m : kRadiiM) {
    for (const double band_m : {kFirstBandM, kBandM, kBandM}) {
      const Fit fit = collect(p_level, plane, radius_m, band_m);
      if (fit.in_band < kLeastPoints) break;
      plane.slope_and_height_m = regular(fit.A).ldlt().solve(fit.b);
    }
  }
  const Fit fit = collect(p_level, plane, kRadiiM.back(), kBandM);
  // The bands beside have twice the width.
  const bool stands_out = fit.in_band >= kLeastContrast * 0.5 * fit.beside;
  if (fit.in_band < kLeastPoints || !stands_out || rings_of(fit) < kLeastLevelRings ||
      plane.slope_and_height_m.head<2>().norm() > kSteepestRad) {
    return std::nullopt;
  }
  plane.points = fit.in_band;
  plane.tilt.tilt_rad = -plane.slope_and_height_m.head<2>();
  const Eigen::Matrix3d inverse = regular(fit.A).inverse();
  plane.tilt.covariance_rad2 = squared(kPointSigmaM) / kIndependentShare * inverse.topLeftCorner<2, 2>();
  return plane;
}

std::array<int, kBins> histogram(std::span<const LevelPoint> p_level) {
  std::array<int, kBins> bins{};
  for (const LevelPoint& point : p_level) {
    const Eigen::Vector3f& p = point.p_m;
    if (p.head<2>().squaredNorm() > kNearM * kNearM || std::abs(p.z()) >= kHighestM) continue;
    ++bins.at(static_cast<std::size_t>((p.z() + kHighestM) / kBinM));
  }
  return bins;
}

}  // namespace

LevelPlanes level_planes(std::span<const LevelPoint> p_level) {
  std::array<int, kBins> bins = histogram(p_level);
  const auto forget = [&bins](std::size_t peak, double around_m) {
    const auto reach = static_cast<std::size_t>(around_m / kBinM);
    const auto begin = bins.begin() + static_cast<std::ptrdiff_t>(peak > reach ? peak - reach : 0);
    std::fill(begin, bins.begin() + static_cast<std::ptrdiff_t>(std::min(peak + reach + 1, kBins)), 0);
  };
  LevelPlanes planes;
  std::size_t found = 0;
  for (int attempt = 0; attempt < kMostAttempts && found < planes.size(); ++attempt) {
    const auto peak = static_cast<std::size_t>(std::max_element(bins.begin(), bins.end()) - bins.begin());
    planes.at(found) = fit_plane(p_level, (static_cast<double>(peak) + 0.5) * kBinM - kHighestM);
    forget(peak, planes.at(found) ? kApartM : kBinM);
    if (planes.at(found)) ++found;
  }
  if (planes[1] && planes[1]->points > planes[0]->points) std::swap(planes[0], planes[1]);
  if (planes[1] && planes[1]->points < kLeastSecondShare * planes[0]->points) planes[1].reset();
  return planes;
}

void remove_planes(const LevelPlanes& planes, std::vector<LevelPoint>& p_level) {
  std::erase_if(p_level, [&planes](const LevelPoint& point) {
    return std::any_of(planes.begin(), planes.end(), [&point](const std::optional<LevelPlane>& plane) {
      return plane && std::abs(plane->distance_m(point.p_m)) < kBandM;
    });
  });
}

}  // namespace isobar
