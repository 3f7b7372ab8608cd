// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/wall_patches.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <cstddef>

#include "core/geometry.hpp"
#include "core/squared.hpp"

namespace isobar {

namespace {

// Grid of cells around the robot: edges along x and y, and along z [m]; number of cells. 1 m holds no second wall of a
// corridor, 2 m hold rings of a 16-beam lidar at several heights.
constexpr float kWallCellM = 1.0F;
constexpr float kWallCellHeightM = 2.0F;
constexpr int kWallCellsAcross = 32;
constexpr int kWallCellsHigh = 4;
constexpr std::size_t kWallCells = std::size_t{kWallCellsAcross} * kWallCellsAcross * kWallCellsHigh;
// Direction of the grid, 25 deg: robots stand parallel to walls, and a wall along an edge would be split in two.
constexpr float kGridCosine = 0.9063F;
constexpr float kGridSine = 0.4226F;
// A patch: least points; largest rms across the plane; least rms along both directions in it [m]; largest tilt [rad].
constexpr int kLeastPatchPoints = 15;
constexpr double kFlatM = 0.03;
constexpr double kExtentM = 0.2;
constexpr float kOnWallM = 0.08F;  // distance of points that belong to a wall
constexpr double kPlumbRad = 5.0 * kRadPerDeg;
// Noise of a point across the plane [m]; of neighbouring points this share is independent.
constexpr double kWallPointSigmaM = 0.02;
constexpr double kWallIndependentShare = 0.25;
// Single walls are plumb to this, 1 sigma; all walls of one direction together to the second.
constexpr double kPatchSigmaRad = 0.3 * kRadPerDeg;
constexpr double kWallSigmaRad = 0.25 * kRadPerDeg;
// Refinements of the planes, before which a cell may hold furniture besides: rms across the plane [m].
constexpr int kRefinements = 2;
constexpr double kMixedM = 0.1;
// A patch agrees with the tilt of all within this; of the plumb patches this share must.
constexpr double kAgreesRad = 1.0 * kRadPerDeg;
constexpr double kLeastAgreeing = 0.6;
constexpr std::size_t kLeastPatches = 6;
// Range errors of the lasers as a slope over their elevation [m/rad], 1 sigma: 1 cm between lasers. They make all walls
// lean away from the lidar, or towards it, in inverse proportion to the distance [m].
constexpr double kRingErrorMRad = 0.02;
constexpr double kLeastDistanceM = 0.5;
// Iterations of the robust fit.
constexpr int kWallIterations = 5;
// Tilt before any wall, 1 sigma [rad]: a direction without walls keeps it.
constexpr double kUnknownTiltRad = 5.0 * kRadPerDeg;

std::optional<std::size_t> cell_index(const Eigen::Vector3f& p) {
  const auto along = [](float x, float edge_m, int cells) {
    return static_cast<int>(std::floor(x / edge_m)) + cells / 2;
  };
  const int x = along(kGridCosine * p.x() + kGridSine * p.y(), kWallCellM, kWallCellsAcross);
  const int y = along(kGridCosine * p.y() - kGridSine * p.x(), kWallCellM, kWallCellsAcross);
  const int z = along(p.z(), kWallCellHeightM, kWallCellsHigh);
  const bool inside =
      x >= 0 && x < kWallCellsAcross && y >= 0 && y < kWallCellsAcross && z >= 0 && z < kWallCellsHigh;
  if (!inside) return std::nullopt;
  return static_cast<std::size_t>((z * kWallCellsAcross + y) * kWallCellsAcross + x);
}

}  // namespace

bool WallPatches::on_wall(const Cell& cell, const Eigen::Vector3f& p) {
  return std::abs(cell.normal.dot(p) - cell.offset_m) < kOnWallM;
}

WallPatches::WallPatches() : cells_(kWallCells) { patches_.reserve(kWallCells); }

std::optional<TiltEvidence> WallPatches::find(std::span<const LevelPoint> p_level) {
  fill(p_level, false);
  collect_patches(kMixedM);
  for (int i = 0; i < kRefinements; ++i) {
    fill(p_level, true);
    collect_patches(i + 1 < kRefinements ? kMixedM : kFlatM);
  }
  if (patches_.size() < kLeastPatches) return std::nullopt;
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kWallIterations; ++i) fit = fit_again(fit, A);
  if (agreeing_share(fit) < kLeastAgreeing) return std::nullopt;
  TiltEvidence out;
  out.tilt_rad = fit.head<2>();
  out.covariance_rad2 =
      A.inverse().topLeftCorner<2, 2>() + squared(kWallSigmaRad) * Eigen::Matrix2d::Identity();
  return out;
}

// Iteratively reweighted least squares with the weights of Cauchy: furniture and trees are no walls.
Eigen::Vector3d WallPatches::fit_again(const Eigen::Vector3d& before, Eigen::Matrix3d& A) const {
  A = Eigen::Vector3d(1.0 / squared(kUnknownTiltRad), 1.0 / squared(kUnknownTiltRad),
                      1.0 / squared(kRingErrorMRad))
          .asDiagonal();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Patch& patch : patches_) {
    const Eigen::Vector3d row = patch.row();
    const double residual = patch.tilt_rad - row.dot(before);
    const double weight = 1.0 / (patch.variance_rad2 + squared(residual));
    A += weight * row * row.transpose();
    b += weight * patch.tilt_rad * row;
  }
  return A.ldlt().solve(b);
}

// `refine`: only points near the planes that were found, so that floor and furniture in a cell leave them.
void WallPatches::fill(std::span<const LevelPoint> p_level, bool refine) {
  for (Cell& cell : cells_) {
    cell.sum.setZero();
    cell.squares.setZero();
    cell.count = 0;
  }
  for (const LevelPoint& point : p_level) {
    const Eigen::Vector3f& p = point.p_m;
    const auto index = cell_index(p);
    if (!index) continue;
    Cell& cell = cells_[*index];
    if (refine && (!cell.plumb || !on_wall(cell, p))) continue;
    const Eigen::Vector3d q = p.cast<double>();
    cell.sum += q;
    cell.squares += q * q.transpose();
    ++cell.count;
  }
}

void WallPatches::collect_patches(double flat_m) {
  patches_.clear();
  for (Cell& cell : cells_) {
    cell.plumb = false;
    const auto patch = patch_of(cell, flat_m);
    if (patch) patches_.push_back(*patch);
  }
}

std::optional<WallPatches::Patch> WallPatches::patch_of(Cell& cell, double flat_m) {
  if (cell.count < kLeastPatchPoints) return std::nullopt;
  const Eigen::Vector3d mean = cell.sum / cell.count;
  const Eigen::Matrix3d covariance = cell.squares / cell.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  const double across = normal.head<2>().norm();
  const bool is_plane =
      eigen.eigenvalues()(0) < squared(flat_m) && eigen.eigenvalues()(1) > squared(kExtentM);
  if (!is_plane || std::abs(normal.z()) > std::sin(kPlumbRad)) return std::nullopt;
  cell.plumb = true;
  cell.normal = normal.cast<float>();
  cell.offset_m = static_cast<float>(normal.dot(mean));
  Patch patch;
  patch.across = normal.head<2>() / across;
  patch.tilt_rad = -normal.z() / across;
  const double distance_m = patch.across.dot(mean.head<2>());
  patch.lean_per_m = 1.0 / std::copysign(std::max(std::abs(distance_m), kLeastDistanceM), distance_m);
  patch.variance_rad2 =
      squared(kWallPointSigmaM) / (kWallIndependentShare * cell.count * eigen.eigenvalues()(1)) +
      squared(kPatchSigmaRad);
  return patch;
}

void WallPatches::remove_walls(std::vector<LevelPoint>& p_level) const {
  std::erase_if(p_level, [this](const LevelPoint& point) {
    const auto index = cell_index(point.p_m);
    if (!index || !cells_[*index].plumb) return false;
    return on_wall(cells_[*index], point.p_m);
  });
}

double WallPatches::agreeing_share(const Eigen::Vector3d& fit) const {
  int agreeing = 0;
  for (const Patch& patch : patches_) {
    if (std::abs(patch.tilt_rad - patch.row().dot(fit)) < kAgreesRad) ++agreeing;
  }
  return static_cast<double>(agreeing) / static_cast<double>(patches_.size());
}

}  // namespace isobar
