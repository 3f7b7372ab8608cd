// SPDX-License-Identifier: BSD-3-Clause
// `moulin`, the paper's third experiment: a sphere on a rope in a vertical shaft of ice.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/samples.hpp"
#include "simulation/scenario.hpp"

namespace isobar::simulation {

using Eigen::Vector3d;

namespace {

constexpr double kPi = std::numbers::pi;

/// Wall of the shaft: its radius is a sum of waves around and along the axis, and the axis itself is curved.
class Shaft {
 public:
  Shaft(Random& random, double depth_m) : depth_m_(depth_m), radius_m_(random.uniform(2.2, 4.5)) {
    for (Wave& wave : waves_) {
      wave.around = static_cast<double>(random.integer(0, 7));
      wave.along_1_m = 2.0 * kPi / random.uniform(1.2, 12.0) * random.sign();
      wave.phase = random.uniform(0.0, 2.0 * kPi);
      // Flutes and scallops: the finer the wave, the lower its amplitude.
      wave.height_m = random.uniform(0.03, 0.12) * radius_m_ / (1.0 + 0.6 * wave.around);
    }
    for (Lean& lean : leans_) {
      lean = {random.uniform(0.1, 0.3), 2.0 * kPi / random.uniform(15.0, 40.0),
              random.uniform(0.0, 2.0 * kPi)};
    }
  }

  [[nodiscard]] double depth_m() const { return depth_m_; }

  /// Point of the wall at depth `below_m` below the surface and angle `angle_rad` around the axis.
  [[nodiscard]] Vector3d wall(double below_m, double angle_rad) const {
    double radius = radius_m_;
    for (const Wave& wave : waves_) {
      radius += wave.height_m * std::sin(wave.around * angle_rad + wave.along_1_m * below_m + wave.phase);
    }
    if (below_m < 2.0) radius += 1.5 * (1.0 - below_m / 2.0);  // the mouth is wider
    radius = std::max(radius, 1.4);
    return {lean(0, below_m) + radius * std::cos(angle_rad), lean(1, below_m) + radius * std::sin(angle_rad),
            -below_m};
  }
  [[nodiscard]] double lean(std::size_t axis, double below_m) const {
    const Lean& lean = leans_[axis];
    return lean.size_m * (std::sin(lean.along_1_m * below_m + lean.phase) - std::sin(lean.phase));
  }

  [[nodiscard]] Mesh mesh(Random& random) const {
    constexpr int kAround = 90;
    constexpr double kAlongM = 0.25;
    Mesh mesh;
    const auto rows = static_cast<int>(depth_m_ / kAlongM);
    const auto point = [&](int row, int column) {
      return wall(kAlongM * row, 2.0 * kPi * (column % kAround) / kAround);
    };
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < kAround; ++column) {
        mesh.quad(point(row, column), point(row, column + 1), point(row + 1, column + 1),
                  point(row + 1, column), Surface::kIce);
      }
    }
    // A floor of rubble, and the snow around the mouth.
    const Vector3d bottom(lean(0, depth_m_), lean(1, depth_m_), -depth_m_ + random.uniform(0.0, 0.4));
    for (int column = 0; column < kAround; ++column) {
      mesh.triangle(bottom, point(rows, column), point(rows, column + 1), Surface::kIce);
      const auto outwards = [&](int at) {
        const Vector3d rim = point(0, at);
        return Vector3d(3.0 * rim.x(), 3.0 * rim.y(), 0.3);
      };
      mesh.quad(point(0, column), point(0, column + 1), outwards(column + 1), outwards(column),
                Surface::kIce);
    }
    return mesh;
  }

 private:
  struct Wave {
    double around = 0.0;
    double along_1_m = 0.0;
    double phase = 0.0;
    double height_m = 0.0;
  };
  struct Lean {
    double size_m = 0.0;
    double along_1_m = 0.0;
    double phase = 0.0;
  };

  double depth_m_;
  double radius_m_;
  std::array<Wave, 14> waves_;
  std::array<Lean, 2> leans_;
};

/// Depth of the sphere per sample: at rest, lowered, at rest, pulled up part of the way; unevenly, as by
/// hand.
std::vector<double> draw_depths(Random& random, double start_m, double end_m, double back_m,
                                double speed_m_s) {
  std::vector<double> depths;
  const auto hold = [&](double seconds) {
    const double depth = depths.empty() ? start_m : depths.back();
    for (double t = 0.0; t < seconds; t += SplineGrid::kStepS) depths.push_back(depth);
  };
  const auto lower_to = [&](double target_m) {
    const double way = target_m - depths.back();
    double v = 0.0;
    GaussMarkov hands(0.15, 2.0, Random(random.next()));
    while (std::abs(target_m - depths.back()) > 0.002) {
      const double left = std::abs(target_m - depths.back());
      const double wanted =
          std::min(speed_m_s * (1.0 + hands.step(SplineGrid::kStepS)), std::sqrt(2.0 * 0.15 * left));
      v = std::max(0.01, v + std::clamp(wanted - v, -0.02, 0.0125));  // 0.25 m/s^2
      depths.push_back(depths.back() + std::copysign(std::min(left, v * SplineGrid::kStepS), way));
    }
  };
  hold(random.uniform(3.0, 8.0));
  lower_to(end_m);
  hold(random.uniform(3.0, 6.0));
  lower_to(back_m);
  hold(3.0);
  return depths;
}

/// Pendulum of the rope's length that swings in two planes and spins slowly.
std::vector<RawPose> swing(Random& random, const Shaft& shaft, const std::vector<double>& depths) {
  constexpr double kPulleyM = 1.5;  // height above the ice
  const std::array<double, 2> amplitude_m{random.uniform(0.05, 0.25), random.uniform(0.05, 0.25)};
  std::array<double, 2> phase{random.uniform(0.0, 2.0 * kPi), random.uniform(0.0, 2.0 * kPi)};
  const double spin_mean = random.sign() * random.uniform(2.0, 6.0) * kPi / 180.0;
  const double spin_size = random.uniform(5.0, 12.0) * kPi / 180.0;
  const double spin_hz = random.uniform(0.01, 0.03);
  const double spin_phase = random.uniform(0.0, 2.0 * kPi);
  std::vector<RawPose> raw;
  double yaw = random.uniform(-kPi, kPi);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double t = SplineGrid::kStepS * static_cast<double>(i);
    const double rope_m = depths[i] + kPulleyM;
    // Held by hand for the first seconds: swing and spin begin when the sphere hangs free.
    const double free = std::clamp((t - 3.0) / 8.0, 0.0, 1.0);
    const double grown = free * free * (3.0 - 2.0 * free);
    std::array<double, 2> offset{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      phase[axis] += std::sqrt(kGravity / rope_m) * (axis == 0 ? 1.0 : 1.01) * SplineGrid::kStepS;
      offset[axis] = grown * std::min(amplitude_m[axis], 0.06 * rope_m) * std::sin(phase[axis]);
    }
    yaw +=
        grown * (spin_mean + spin_size * std::sin(2.0 * kPi * spin_hz * t + spin_phase)) * SplineGrid::kStepS;
    // The sphere's z axis points along the rope, like the force on a pendulum.
    const Vector3d up = Vector3d(-offset[0], -offset[1], rope_m).normalized();
    const double along = std::cos(yaw) * up.x() + std::sin(yaw) * up.y();
    const double across = -std::sin(yaw) * up.x() + std::cos(yaw) * up.y();
    RawPose pose;
    pose.x_m = 0.8 * shaft.lean(0, depths[i]) + offset[0];
    pose.y_m = 0.8 * shaft.lean(1, depths[i]) + offset[1];
    pose.z_m = -depths[i];
    pose.yaw_rad = yaw;
    pose.pitch_rad = std::atan2(along, up.z());
    pose.roll_rad = -std::asin(across);
    raw.push_back(pose);
  }
  return raw;
}

}  // namespace

Scenario make_moulin(std::uint64_t seed, bool short_form) {
  Random random(seed, "moulin");
  const Shaft shaft(random, short_form ? random.uniform(16.0, 20.0) : random.uniform(30.0, 60.0));
  const double speed_m_s = random.uniform(0.22, 0.38);
  const double start_m = random.uniform(2.0, 3.0);
  const double end_m = short_form ? start_m + 9.0 : shaft.depth_m() - random.uniform(3.0, 5.0);
  const double back_m = end_m - (short_form ? 2.0 : random.uniform(0.3, 0.7) * (end_m - start_m));

  Scenario scenario;
  scenario.description = "a hanging sphere in a vertical shaft of ice";
  scenario.raw = swing(random, shaft, draw_depths(random, start_m, end_m, back_m, speed_m_s));
  scenario.labels = {{0.0, SplineGrid::kStepS * static_cast<double>(scenario.raw.size() - 1), "shaft"}};
  scenario.trajectory = Trajectory(scenario.raw);
  scenario.world = World(shaft.mesh(random), {});
  scenario.has_wheels = false;
  scenario.mounts.lidar = {{0.0, 0.0, 0.05}, {0.0, 0.0, 0.0}};
  if (random.chance(0.5)) scenario.mounts.lidar.rpy_deg = {0.0, std::round(random.uniform(20.0, 40.0)), 0.0};
  scenario.mounts.imu = {{0.0, 0.0, -0.05}, {0.0, 0.0, 0.0}};
  scenario.mounts.pressure_port_m = {0.08, 0.0, 0.0};
  scenario.air_temperature_c = random.uniform(-1.0, 3.0);  // of the glacier
  scenario.base_height_m = random.uniform(0.5, 1.5);
  scenario.start_pressure_pa = 80'000.0 + random.normal(3'000.0);  // a glacier at about 2000 m
  return scenario;
}

}  // namespace isobar::simulation
