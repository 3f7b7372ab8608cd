// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isobar::simulation {

using Eigen::Vector3d;

namespace {

constexpr double kPi = std::numbers::pi;

/// Diffuse reflectivity (0 … 1) at 903 nm, the order of magnitude of published spectra.
double reflectivity(Surface surface) {
  switch (surface) {
    case Surface::kPlaster:
      return 0.75;
    case Surface::kConcrete:
      return 0.35;
    case Surface::kWood:
      return 0.50;
    case Surface::kMetal:
      return 0.30;
    case Surface::kCloth:
      return 0.40;
    case Surface::kIce:
      return 0.25;
  }
  return 0.5;
}

}  // namespace

LidarErrors LidarErrors::draw(Random random, const LidarPlan& plan) {
  constexpr std::size_t kFirstLasers = 16;  // others are drawn last: a seed gives the same to all models
  LidarErrors errors;
  errors.range_sigma_m = random.uniform(plan.range.sigma_low_m, plan.range.sigma_high_m);
  for (std::size_t i = 0; i < kFirstLasers; ++i) {
    errors.range_bias_m[i] = random.normal(plan.range.bias_sigma_m);
  }
  // Motor: the manual allows +-3 rpm around the set speed of 600 rpm; packets also show a slow oscillation.
  errors.azimuth_offset_rad = random.uniform(0.0, 2.0 * kPi);
  errors.spin_rate_rad_s = 2.0 * kPi * (10.0 + random.normal(0.01));
  errors.spin_wobble_rad = random.uniform(0.0002, 0.001);
  errors.spin_wobble_hz = random.uniform(0.3, 1.5);
  // Without GPS the sensor's clock starts at an arbitrary time; crystals have errors of some tens of ppm.
  errors.clock_offset_s = random.uniform(0.0, 3600.0);
  errors.clock_drift = random.normal(15e-6);
  // A direct Ethernet link into a Linux receive queue.
  errors.latency_s = random.uniform(120e-6, 250e-6);
  errors.latency_jitter_s = random.uniform(30e-6, 120e-6);
  errors.reach_m = plan.range.reach_m;
  errors.angle_sigma_rad = plan.range.angle_sigma_rad;
  errors.fades = true;
  for (std::size_t i = kFirstLasers; i < plan.lasers; ++i) {
    errors.range_bias_m[i] = random.normal(plan.range.bias_sigma_m);
  }
  return errors;
}

LidarModel::LidarModel(const LidarPlan& plan, const World& world, const Trajectory& trajectory,
                       const Eigen::Isometry3d& T_base_lidar, const LidarErrors& errors, std::uint64_t seed)
    : plan_(plan),
      world_(world),
      trajectory_(trajectory),
      T_base_lidar_(T_base_lidar),
      errors_(errors),
      seed_(seed),
      cycle_s_(plan.cycle_s) {
  if (plan.sweep == LidarSweep::kColumns) {
    // The encoder triggers the firings, from position 0 on.
    errors_.azimuth_offset_rad = 0.0;
    errors_.spin_wobble_rad = 0.0;
    cycle_s_ = 2.0 * kPi / errors.spin_rate_rad_s / static_cast<double>(plan.columns);
  }
  packet_s_ = static_cast<double>(plan.cycles) * cycle_s_;
  for (std::size_t laser = 0; laser < plan.lasers; ++laser) {
    const double elevation_rad = plan.elevation_deg[laser] * kPi / 180.0;
    cos_elevation_[laser] = std::cos(elevation_rad);
    sin_elevation_[laser] = std::sin(elevation_rad);
    ahead_rad_[laser] = (plan.azimuth_ahead_deg[laser] + plan.zero_deg) * kPi / 180.0;
  }
}

double LidarModel::azimuth_rad(double time_s) const {
  return errors_.azimuth_offset_rad + errors_.spin_rate_rad_s * time_s +
         errors_.spin_wobble_rad * std::sin(2.0 * kPi * errors_.spin_wobble_hz * time_s);
}

LidarModel::Beam LidarModel::rotor_beam(std::size_t laser, double azimuth) const {
  const double a = azimuth + ahead_rad_[laser];
  Beam beam{Vector3d::Zero(), Vector3d(cos_elevation_[laser] * std::cos(a),
                                       -cos_elevation_[laser] * std::sin(a), sin_elevation_[laser])};
  if (plan_.origin_radius_m > 0.0) {
    const double rotor = azimuth + plan_.zero_deg * kPi / 180.0;
    beam.origin = Vector3d(plan_.origin_radius_m * std::cos(rotor), -plan_.origin_radius_m * std::sin(rotor),
                           plan_.origin_height_m);
  }
  return beam;
}

LidarModel::Beam LidarModel::rosette_beam(std::size_t laser, double time_s) const {
  // Livox does not publish the pattern. This one has its measures: four lasers sweep the field of view up and down
  // while the whole turns, both at speeds without a small common multiple, with a uniform density in elevation.
  constexpr double kLowDeg = -7.0;
  constexpr double kHighDeg = 52.0;
  constexpr double kTurnHz = 9.973;
  constexpr double kSweepHz = 197.31;
  const double line = static_cast<double>(laser) / static_cast<double>(plan_.lasers);
  const double phase = kSweepHz * time_s + line;
  const double share = std::abs(2.0 * (phase - std::floor(phase)) - 1.0);
  const double elevation = (kLowDeg + (kHighDeg - kLowDeg) * share) * kPi / 180.0;
  const double azimuth = errors_.azimuth_offset_rad + 2.0 * kPi * (kTurnHz * time_s + line);
  return {Vector3d::Zero(), Vector3d(std::cos(elevation) * std::cos(azimuth),
                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation))};
}

void LidarModel::measure(const Hit& hit, std::size_t laser, Random& random, LaserReturn& measured) const {
  if (!hit.found || static_cast<double>(hit.distance_m) < plan_.range.min_m) return;
  const double range_m = hit.distance_m;
  const double cosine = hit.cos_incidence;
  // Lambertian surface: echo power is proportional to the cosine of incidence and falls with the square of
  // the range.
  const double albedo = reflectivity(hit.surface);
  const double echo =
      albedo * std::max(cosine, 0.02) * std::pow(errors_.reach_m / std::max(range_m, 1.0), 2.0);
  if (errors_.fades) {
    // A wall of 75 % reflectivity at normal incidence is detected up to reach_m; weaker echoes are detected
    // with a probability proportional to their power.
    constexpr double kThreshold = 0.75;
    if (random.uniform() > std::min(1.0, echo / kThreshold) || cosine < 0.01) return;
  }
  double sigma_m = errors_.range_sigma_m;
  // At oblique incidence the spot of the beam extends in depth over range * divergence * tan(incidence).
  if (sigma_m > 0.0) {
    const double smear =
        0.15 * plan_.range.beam_rad * range_m * std::sqrt(1.0 - cosine * cosine) / std::max(cosine, 0.05);
    sigma_m = std::hypot(sigma_m, std::min(smear, 0.05));
  }
  measured.distance_m = range_m + errors_.range_bias_m[laser] + random.normal(sigma_m);
  if (measured.distance_m > errors_.reach_m) measured.distance_m = 0.0;
  const double calibrated = 100.0 * albedo * std::sqrt(cosine) + random.normal(2.0);
  measured.reflectivity = static_cast<std::uint8_t>(std::clamp(calibrated, 1.0, 100.0));
}

void LidarModel::fire_cycle(double time_s, FiringCycle& cycle, World::Moment& moment, Random& random) const {
  const MotionState state = trajectory_.at(time_s);
  const Eigen::Matrix3d R_world_base = state.q_world_base.toRotationMatrix();
  const Vector3d eye = state.p_world + R_world_base * T_base_lidar_.translation();
  const Vector3d eye_velocity =
      state.v_world + R_world_base * state.w_base.cross(T_base_lidar_.translation());
  const Eigen::Matrix3d R_world_lidar = R_world_base * T_base_lidar_.rotation();
  const Vector3d w_world = R_world_base * state.w_base;
  world_.look(time_s, eye, errors_.reach_m, moment);
  cycle.azimuth_rad = azimuth_rad(time_s);
  const double azimuth_step = azimuth_rad(time_s + plan_.slot_s) - cycle.azimuth_rad;
  for (std::size_t laser = 0; laser < plan_.lasers; ++laser) {
    // Pose at the firing time of this laser, to first order: second-order terms over 50 us are below a
    // nanometre.
    const double later_s = plan_.first_s + plan_.slot_s * plan_.slot[laser];
    const double turned_by = plan_.one_azimuth ? 0.0 : azimuth_step * plan_.slot[laser];
    const Beam beam = plan_.sweep == LidarSweep::kRosette ? rosette_beam(laser, time_s + later_s)
                                                          : rotor_beam(laser, cycle.azimuth_rad + turned_by);
    LaserReturn& measured = cycle.returns[laser];
    measured.beam = beam.direction;
    Vector3d turned = R_world_lidar * beam.direction;
    if (errors_.angle_sigma_rad > 0.0) {
      const Vector3d aside = turned.unitOrthogonal();
      turned += random.normal(errors_.angle_sigma_rad) * aside +
                random.normal(errors_.angle_sigma_rad) * turned.cross(aside);
    }
    const Vector3d direction = (turned + later_s * w_world.cross(turned)).normalized();
    Vector3d start = eye + later_s * eye_velocity;
    if (plan_.origin_radius_m > 0.0) start += R_world_lidar * beam.origin;
    measure(world_.cast(moment, start, direction, errors_.reach_m + 1.0), laser, random, measured);
  }
}

ReceivedPacket LidarModel::packet(std::uint64_t n) const {
  Random random(seed_, "lidar packet", n);
  const double start_s = packet_time_s(n);
  LidarPacket packet;
  packet.number = n;
  packet.cycles.resize(plan_.cycles);
  World::Moment moment;
  for (std::size_t cycle = 0; cycle < plan_.cycles; ++cycle) {
    fire_cycle(start_s + cycle_s_ * static_cast<double>(cycle), packet.cycles[cycle], moment, random);
  }
  packet.sensor_s = errors_.clock_offset_s + (1.0 + errors_.clock_drift) * start_s;
  packet.cycle_s = (1.0 + errors_.clock_drift) * cycle_s_;
  packet.turn_hz = errors_.spin_rate_rad_s / (2.0 * kPi);
  ReceivedPacket received;
  received.receive_time_s = start_s + packet_s_ + errors_.latency_s;
  if (errors_.latency_jitter_s > 0.0) received.receive_time_s += random.exponential(errors_.latency_jitter_s);
  received.bytes = encode(plan_, packet);
  return received;
}

}  // namespace isobar::simulation
