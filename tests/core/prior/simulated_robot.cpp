// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/prior/simulated_robot.hpp"

#include <algorithm>

#include "core/altitude/hypsometry.hpp"
#include "core/so3.hpp"
#include "tests/core/altitude/isothermal_air.hpp"

namespace isobar::test {
namespace {

constexpr double kStep = 1e-3;  // of numerical derivatives [s]
constexpr double kBasePa = 101'000.0;

std::int64_t to_ns(double t) {
  return 1'700'000'000'000'000'000 + static_cast<std::int64_t>(std::llround(t * 1e9));
}

struct Generator {
  const SimulatedRobot& robot;
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  Eigen::Vector3d gyro_bias, accel_bias;
  Eigen::Quaterniond mount_error;
  double wheel_scale, warm_up, offset_pa;
  double turbulence[2] = {0.0, 0.0};
  double turbulence_t[2] = {0.0, 0.0};

  Generator(const SimulatedRobot& r, unsigned seed) : robot(r), random(seed) {
    const SensorErrors& e = robot.errors;
    gyro_bias = e.gyro_bias * vector();
    accel_bias = e.accel_bias * vector();
    Eigen::Vector3d tilt = e.misalignment * vector();
    tilt.z() = 0.0;
    mount_error = exp_so3(tilt);
    wheel_scale = 1.0 + e.wheel_scale * draw();
    warm_up = e.warm_up * draw();
    offset_pa = 50.0 * draw();
    for (double& value : turbulence) value = e.turbulence * draw();
  }

  double draw() { return normal(random); }
  Eigen::Vector3d vector() {
    const double x = draw();
    const double y = draw();
    return {x, y, draw()};
  }

  Eigen::Vector3d body_velocity(double t) const {
    const Eigen::Vector3d v = (robot.motion(t + kStep).p - robot.motion(t - kStep).p) / (2.0 * kStep);
    return robot.motion(t).q.conjugate() * v;
  }

  ImuSample imu(double t) {
    const SensorErrors& e = robot.errors;
    const auto place = [&](double at) {
      const Pose pose = robot.motion(at);
      return Eigen::Vector3d(pose.p + pose.q * robot.T_base_imu.translation());
    };
    const Pose pose = robot.motion(t);
    const Eigen::Vector3d a = (place(t + kStep) - 2.0 * place(t) + place(t - kStep)) / (kStep * kStep);
    const Eigen::Vector3d rate =
        log_so3(robot.motion(t - kStep).q.conjugate() * robot.motion(t + kStep).q) / (2.0 * kStep);
    const Eigen::Quaterniond to_imu = mount_error * Eigen::Quaterniond(robot.T_base_imu.linear()).conjugate();
    const double speed =
        (robot.motion(t + kStep).p - robot.motion(t - kStep).p).head<2>().norm() / (2.0 * kStep);
    const double vibration = speed > 0.02 ? e.vibration : 0.0;
    ImuSample sample;
    sample.stamp_ns = to_ns(t);
    sample.gyro_rad_s = to_imu * rate + gyro_bias + e.gyro_noise * vector();
    sample.accel_m_s2 = to_imu * (pose.q.conjugate() * (a + Eigen::Vector3d(0.0, 0.0, kGravity))) +
                        accel_bias + std::hypot(e.accel_noise, vibration) * vector();
    return sample;
  }

  WheelSample wheel(double t) {
    const SensorErrors& e = robot.errors;
    // A lift moves the robot without turning its wheels.
    const Pose pose = robot.motion(t);
    const Eigen::Vector3d v = (robot.motion(t + kStep).p - robot.motion(t - kStep).p) / (2.0 * kStep);
    const double horizontal = v.head<2>().norm();
    const double pitch = pitch_of(pose.q.toRotationMatrix());
    const double slip = std::abs(pitch) > 0.17 ? 1.0 + e.stairs_slip : 1.0;
    const Eigen::Vector3d rate =
        log_so3(robot.motion(t - kStep).q.conjugate() * robot.motion(t + kStep).q) / (2.0 * kStep);
    WheelSample sample;
    sample.stamp_ns = to_ns(t);
    const bool turning = horizontal > 1e-3;
    sample.vx_m_s =
        turning ? wheel_scale * slip * horizontal / std::cos(pitch) + e.wheel_noise * draw() : 0.0;
    sample.wz_rad_s = turning ? 1.05 * rate.z() : 0.0;
    return sample;
  }

  PressureSample pressure(double t, int sensor) {
    const SensorErrors& e = robot.errors;
    const double dt = t - turbulence_t[sensor];
    const double keep = std::exp(-dt / e.turbulence_time_s);
    turbulence[sensor] = keep * turbulence[sensor] + e.turbulence * std::sqrt(1.0 - keep * keep) * draw();
    turbulence_t[sensor] = t;
    const double warm = 1.0 - std::exp(-t / 300.0);
    double pa = kBasePa + e.weather_pa_s * t + robot.common_pa(t);
    if (sensor == 0) {
      const Pose pose = robot.motion(t);
      const double z = (pose.p + pose.q * robot.p_base_port).z();
      pa = hypsometric_pressure_pa(pa, z + 1.5, robot.air_k) + offset_pa + warm_up * warm +
           robot.extra_robot_pa(t);
    }
    PressureSample sample;
    sample.stamp_ns = to_ns(t);
    sample.pressure_pa = pa + turbulence[sensor] + e.pressure_noise * draw();
    sample.temperature_c =
        robot.air_k - kZeroCelsiusK + e.self_heating_k * warm + (sensor == 0 ? 0.3 : 0.0) + 0.02 * draw();
    return sample;
  }
};

}  // namespace

std::vector<Comparison> run(const SimulatedRobot& robot, const PriorConfig& config, unsigned seed,
                            PriorCounters* counters, int every) {
  Generator generator(robot, seed);
  PriorEstimator estimator(config);
  std::vector<Comparison> result;
  const Pose start = robot.motion(0.0);
  const auto period = [](double hz) { return hz > 0.0 ? 1.0 / hz : 1e18; };
  double next_imu = 0.0;
  double next_wheel = robot.wheel_hz > 0.0 ? 0.003 : 1e18;
  double next_robot = robot.robot_hz > 0.0 ? 0.011 : 1e18;
  double next_base = robot.base_hz > 0.0 ? 0.007 : 1e18;
  int count = 0;
  for (;;) {
    const double arrival_base = next_base + robot.base_delay_s;
    const double t = std::min({next_imu, next_wheel, next_robot, arrival_base});
    if (t > robot.duration_s) break;
    if (t == next_wheel) {
      const WheelSample sample = generator.wheel(t);
      if (robot.wheels_on(t)) estimator.add_wheel(sample);
      next_wheel += period(robot.wheel_hz);
    } else if (t == next_robot) {
      const PressureSample sample = generator.pressure(t, 0);
      if (robot.robot_on(t)) estimator.add_pressure(sample);
      next_robot += period(robot.robot_hz);
    } else if (t == arrival_base) {
      const PressureSample sample = generator.pressure(next_base, 1);
      if (robot.base_on(next_base)) estimator.add_base_pressure(sample);
      next_base += period(robot.base_hz);
    } else {
      const ImuSample sample = generator.imu(t);
      next_imu += period(robot.imu_hz);
      Comparison comparison;
      if (!robot.imu_on(t) || !estimator.add_imu(sample, comparison.prior) || count++ % every != 0) continue;
      comparison.t = t;
      comparison.truth = robot.motion(t);
      comparison.height_truth_m = comparison.truth.p.z() - start.p.z();
      const Eigen::Matrix3d R = comparison.prior.T_odom_base.linear();
      const Eigen::Matrix3d R_true = comparison.truth.q.toRotationMatrix();
      comparison.roll_error_rad = roll_of(R) - roll_of(R_true);
      comparison.pitch_error_rad = pitch_of(R) - pitch_of(R_true);
      result.push_back(comparison);
    }
  }
  if (counters != nullptr) *counters = estimator.counters();
  return result;
}

Figures figures_of(const std::vector<Comparison>& comparisons, double from_s) {
  Figures figures;
  double n = 0.0;
  std::vector<double> rpe;
  std::size_t back = 0;
  double travelled_m = 0.0;
  std::vector<double> distance(comparisons.size(), 0.0);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const Comparison& c = comparisons[i];
    if (i > 0) travelled_m += (c.truth.p - comparisons[i - 1].truth.p).head<2>().norm();
    distance[i] = travelled_m;
    if (c.t < from_s) continue;
    const double error = c.prior.height_m - c.height_truth_m;
    n += 1.0;
    figures.roll_pitch_rms_rad +=
        0.5 * (c.roll_error_rad * c.roll_error_rad + c.pitch_error_rad * c.pitch_error_rad);
    figures.height_rms_m += error * error;
    figures.height_max_m = std::max(figures.height_max_m, std::abs(error));
    figures.height_final_m = error;
    figures.nees += error * error / c.prior.height_variance_m2;
    while (distance[i] - distance[back + 1] >= 5.0) ++back;
    if (distance[i] - distance[back] < 5.0 || comparisons[back].t < from_s) continue;
    const Comparison& b = comparisons[back];
    rpe.push_back(std::abs(error - (b.prior.height_m - b.height_truth_m)) / 5.0);
  }
  figures.roll_pitch_rms_rad = std::sqrt(figures.roll_pitch_rms_rad / n);
  figures.height_rms_m = std::sqrt(figures.height_rms_m / n);
  figures.nees /= n;
  if (!rpe.empty()) {
    std::nth_element(rpe.begin(), rpe.begin() + static_cast<std::ptrdiff_t>(rpe.size() / 2), rpe.end());
    figures.z_rpe_median = rpe[rpe.size() / 2];
  }
  return figures;
}

}  // namespace isobar::test
