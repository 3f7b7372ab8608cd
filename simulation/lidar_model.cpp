// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isobar::simulation {

using Eigen::Vector3d;

namespace {

constexpr double kCycleS = 1e-9 * static_cast<double>(velodyne::kVlp16.firing_cycle_ns);
constexpr double kFiringStepS = 1e-9 * static_cast<double>(velodyne::kVlp16.firing_step_ns);
constexpr double kPi = std::numbers::pi;
constexpr double kMinRangeM = 0.4;  // user manual: returns from less than about 0.4 m are unreliable

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

LidarErrors LidarErrors::draw(Random random) {
  LidarErrors errors;
  // VLP-16 data sheet 63-9229: "range accuracy up to +-3 cm (typical)". Glennie, Kusari, Facchin 2016,
  // "Calibration and stability analysis of the VLP-16": noise of 1 to 1.5 cm, bias of about 1 cm per laser.
  errors.range_sigma_m = random.uniform(0.010, 0.014);
  for (double& bias : errors.range_bias_m) bias = random.normal(0.006);
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
  errors.fades = true;
  return errors;
}

LidarModel::LidarModel(const World& world, const Trajectory& trajectory,
                       const Eigen::Isometry3d& T_base_lidar, const LidarErrors& errors, std::uint64_t seed)
    : world_(world), trajectory_(trajectory), T_base_lidar_(T_base_lidar), errors_(errors), seed_(seed) {
  for (std::size_t laser = 0; laser < 16; ++laser) {
    const double elevation_rad = velodyne::kVlp16.elevation_deg[laser] * kPi / 180.0;
    cos_elevation_[laser] = std::cos(elevation_rad);
    sin_elevation_[laser] = std::sin(elevation_rad);
  }
}

double LidarModel::packet_time_s(std::uint64_t n) {
  return static_cast<double>(n) * (Vlp16Packet::kCycles * kCycleS);
}

double LidarModel::azimuth_rad(double time_s) const {
  return errors_.azimuth_offset_rad + errors_.spin_rate_rad_s * time_s +
         errors_.spin_wobble_rad * std::sin(2.0 * kPi * errors_.spin_wobble_hz * time_s);
}

LaserReturn LidarModel::measure(const Hit& hit, std::size_t laser, Random& random) const {
  LaserReturn measured;
  if (!hit.found || static_cast<double>(hit.distance_m) < kMinRangeM) return measured;
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
    if (random.uniform() > std::min(1.0, echo / kThreshold) || cosine < 0.01) return measured;
  }
  double sigma_m = errors_.range_sigma_m;
  // At oblique incidence the spot of the beam (3 mrad) extends in depth over range * 3 mrad * tan(incidence).
  constexpr double kBeamRad = 0.003;
  if (sigma_m > 0.0) {
    const double smear =
        0.15 * kBeamRad * range_m * std::sqrt(1.0 - cosine * cosine) / std::max(cosine, 0.05);
    sigma_m = std::hypot(sigma_m, std::min(smear, 0.05));
  }
  measured.distance_m = range_m + errors_.range_bias_m[laser] + random.normal(sigma_m);
  if (measured.distance_m > errors_.reach_m) measured.distance_m = 0.0;
  const double calibrated = 100.0 * albedo * std::sqrt(cosine) + random.normal(2.0);
  measured.reflectivity = static_cast<std::uint8_t>(std::clamp(calibrated, 1.0, 100.0));
  return measured;
}

void LidarModel::fire_cycle(double time_s, std::array<LaserReturn, 16>& returns, World::Moment& moment,
                            Random& random) const {
  const MotionState state = trajectory_.at(time_s);
  const Eigen::Matrix3d R_world_base = state.q_world_base.toRotationMatrix();
  const Vector3d eye = state.p_world + R_world_base * T_base_lidar_.translation();
  const Vector3d eye_velocity =
      state.v_world + R_world_base * state.w_base.cross(T_base_lidar_.translation());
  const Eigen::Matrix3d R_world_lidar = R_world_base * T_base_lidar_.rotation();
  const Vector3d w_world = R_world_base * state.w_base;
  world_.look(time_s, eye, errors_.reach_m, moment);
  const double azimuth = azimuth_rad(time_s);
  const double azimuth_step = azimuth_rad(time_s + kFiringStepS) - azimuth;
  for (std::size_t laser = 0; laser < 16; ++laser) {
    // Pose at the firing time of this laser, to first order: second-order terms over 35 us are below a
    // nanometre.
    const double later_s = kFiringStepS * static_cast<double>(laser);
    const double a = azimuth + azimuth_step * static_cast<double>(laser);
    const Vector3d beam(cos_elevation_[laser] * std::cos(a), -cos_elevation_[laser] * std::sin(a),
                        sin_elevation_[laser]);
    const Vector3d turned = R_world_lidar * beam;
    const Vector3d direction = (turned + later_s * w_world.cross(turned)).normalized();
    const Hit hit = world_.cast(moment, eye + later_s * eye_velocity, direction, errors_.reach_m + 1.0);
    returns[laser] = measure(hit, laser, random);
  }
}

ReceivedPacket LidarModel::packet(std::uint64_t n) const {
  Random random(seed_, "lidar packet", n);
  const double start_s = packet_time_s(n);
  Vlp16Packet packet;
  World::Moment moment;
  for (std::size_t cycle = 0; cycle < Vlp16Packet::kCycles; ++cycle) {
    const double time_s = start_s + kCycleS * static_cast<double>(cycle);
    if (cycle % 2 == 0) packet.azimuth_rad[cycle / 2] = azimuth_rad(time_s);
    fire_cycle(time_s, packet.returns[cycle], moment, random);
  }
  const double sensor_s = std::fmod(errors_.clock_offset_s + (1.0 + errors_.clock_drift) * start_s, 3600.0);
  packet.timestamp_us = static_cast<std::uint32_t>(sensor_s * 1e6);
  ReceivedPacket received;
  received.receive_time_s = start_s + Vlp16Packet::kCycles * kCycleS + errors_.latency_s;
  if (errors_.latency_jitter_s > 0.0) received.receive_time_s += random.exponential(errors_.latency_jitter_s);
  received.bytes = encode(packet);
  return received;
}

}  // namespace isobar::simulation
