// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/terrain.hpp"

#include <cmath>
#include <numbers>

namespace isobar::simulation {

using Eigen::Vector2d;

Terrain::Terrain(Random random, double steepest, double scale) {
  // Range of each wavelength, and share of the wave in the maximum slope: the slope amplitudes add up to
  // `steepest`.
  struct Kind {
    double shortest_m;
    double longest_m;
    double share;
  };
  constexpr std::array<Kind, 4> kKinds{
      Kind{900.0, 1300.0, 0.30}, {550.0, 800.0, 0.35}, {350.0, 500.0, 0.20}, {180.0, 260.0, 0.15}};
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const double number =
        2.0 * std::numbers::pi / (scale * random.uniform(kKinds[i].shortest_m, kKinds[i].longest_m));
    const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
    waves_[i].number_1_m = number * Vector2d(std::cos(direction), std::sin(direction));
    waves_[i].height_m = kKinds[i].share * steepest / number;
    waves_[i].phase_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  }
}

double Terrain::height_m(const Vector2d& at_m) const {
  double height = 0.0;
  for (const Wave& wave : waves_) {
    height +=
        wave.height_m * (std::sin(wave.number_1_m.dot(at_m) + wave.phase_rad) - std::sin(wave.phase_rad));
  }
  return height;
}

Vector2d Terrain::slope(const Vector2d& at_m) const {
  Vector2d slope = Vector2d::Zero();
  for (const Wave& wave : waves_) {
    slope += wave.height_m * std::cos(wave.number_1_m.dot(at_m) + wave.phase_rad) * wave.number_1_m;
  }
  return slope;
}

void drape(std::vector<RawPose>& poses, const Terrain& terrain) {
  for (RawPose& pose : poses) {
    const Vector2d at(pose.x_m, pose.y_m);
    const Vector2d forward(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    const Vector2d slope = terrain.slope(at);
    pose.z_m = terrain.height_m(at);
    pose.pitch_rad = -std::atan(slope.dot(forward));
    pose.roll_rad = std::atan(slope.dot(Vector2d(-forward.y(), forward.x())) * std::cos(pose.pitch_rad));
  }
}

}  // namespace isobar::simulation
