// SPDX-License-Identifier: BSD-3-Clause
// Model of an inertial measurement unit on a vibrating robot.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "core/samples.hpp"
#include "simulation/random.hpp"
#include "simulation/trajectory.hpp"

namespace isobar::simulation {

/// Errors of one unit. The defaults are zero, for tests.
struct ImuErrors {
  std::string model = "ideal";
  double gyro_density_rad_s_rthz = 0.0;
  double accel_density_m_s2_rthz = 0.0;
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();  ///< turn-on bias
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();  ///< turn-on bias
  double gyro_instability_rad_s = 0.0;                        ///< in-run bias instability, rms
  double accel_instability_m_s2 = 0.0;                        ///< in-run bias instability, rms
  Eigen::Matrix3d gyro_scale = Eigen::Matrix3d::Identity();   ///< scale and misalignment
  Eigen::Matrix3d accel_scale = Eigen::Matrix3d::Identity();  ///< scale and misalignment
  double vibration_m_s2 = 0.0;                                ///< rms per axis at 0.6 m/s on a flat floor
  double vibration_rad_s = 0.0;                               ///< rms per axis at 0.6 m/s on a flat floor
  double cabin_vibration_m_s2 = 0.0;  ///< vertical rms in an elevator at 1 m/s and above
  bool has_attitude = false;          ///< the unit outputs its own attitude estimate
  double attitude_sigma_rad = 0.0;    ///< rms error of that estimate, per axis

  /// Random errors with the data-sheet figures of the paper's MTi-10 or VN-100; sources in imu_model.cpp.
  /// `tracked`: the robot has tracks, which vibrate.
  [[nodiscard]] static ImuErrors draw(Random random, bool tracked);
};

/// One unit. Samples must be taken in time order.
class ImuModel {
 public:
  static constexpr double kRateHz = 200.0;

  ImuModel(const Trajectory& trajectory, const Eigen::Isometry3d& T_base_imu, const ImuErrors& errors,
           Random random);

  /// Sample at `time_s`. The caller sets stamp_ns.
  [[nodiscard]] ImuSample sample(double time_s);

 private:
  [[nodiscard]] Eigen::Vector3d white(double sigma);
  void wander(Eigen::Vector3d& bias, double sigma);
  [[nodiscard]] double vibrate_cabin(double speed_m_s);

  const Trajectory& trajectory_;
  Eigen::Isometry3d T_base_imu_;
  ImuErrors errors_;
  Random random_;
  Random cabin_random_;
  Eigen::Vector3d gyro_wander_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_wander_ = Eigen::Vector3d::Zero();
  double cabin_m_ = 0.0;  // displacement of the vibrating cabin, and its speed
  double cabin_m_s_ = 0.0;
  Eigen::Vector3d attitude_wander_ = Eigen::Vector3d::Zero();
};

}  // namespace isobar::simulation
