// SPDX-License-Identifier: BSD-3-Clause
// Messages between the stages of the pipeline.
//
// Frames (REP-103, REP-105): base_link is the robot; odom is the frame of dead reckoning, map that of the
// registered poses. Both are gravity-aligned at the start, z up. The height of base_link is 0 at the start.
// T_odom_base here is the raw dead reckoning; the odom frame of Odometry (registration/pose_propagator.hpp)
// follows the registration and is another one.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/localisability.hpp"
#include "core/samples.hpp"

namespace isobar {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Source of a height, best first.
enum class HeightSource : std::uint8_t {
  kDifferential,     ///< robot's barometer against a base station's
  kSingleBarometer,  ///< robot's barometer against its own start: drifts with the weather
  kHeld,             ///< barometer lost: dead reckoning since then
  kNone,             ///< never had a barometer
};

/// Barometer that drifts.
enum class DriftSuspect : std::uint8_t {
  kNone,
  kRobot,    ///< the robot's
  kBase,     ///< the base station's in use
  kUnknown,  ///< one of both
};

/// Output of the prior stage at one IMU sample: the estimate without the lidar.
struct Prior {
  std::int64_t stamp_ns = 0;

  /// Dead reckoning of base_link from IMU and wheels. Roll and pitch from gravity, yaw from the gyro,
  /// translation from wheels, z included (no barometer). Continuous; drifts.
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();

  /// Height of base_link above its start from air pressure, corrected for the port's lever arm [m].
  double height_m = 0.0;
  double height_variance_m2 = 0.0;
  HeightSource height_source = HeightSource::kNone;

  /// The last altimeter reading, without any filter: height of base_link from air pressure alone [m], its white noise
  /// [m^2], and the number of readings so far.
  double altimeter_m = 0.0;
  double altimeter_variance_m2 = 0.0;
  std::uint32_t altimeter_count = 0;
  /// Sum of the steps of altimeter_m that a base station made by returning or taking over [m].
  double altimeter_shift_m = 0.0;
  /// The base station's part of altimeter_m: the change of its pressure since the first reading, as a height [m].
  double base_air_m = 0.0;
  double up_accel_m_s2 = 0.0;  ///< vertical specific force of the sample minus gravity, biases included
  bool ground_moves = false;   ///< the ground that carries the robot rises or sinks: an elevator

  Eigen::Vector3d v_base_m_s = Eigen::Vector3d::Zero();    ///< velocity of base_link in base_link
  Eigen::Vector3d w_base_rad_s = Eigen::Vector3d::Zero();  ///< angular rate in base_link, gyro bias removed

  double wheel_turn_rad = 0.0;  ///< sum of the turns about z by the wheels; gaps count as zero

  /// Bias of the accelerometer as far as the attitude filter has learnt it, in base_link: T_odom_base is free of it.
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();

  double roll_pitch_variance_rad2 = 0.0;   ///< of roll and of pitch, each
  double yaw_rate_variance_rad2_s2 = 0.0;  ///< of the angular rate about z, bias included
  double yaw_bias_variance_rad2_s2 = 0.0;  ///< the part of it that lasts: the gyro's bias
  double velocity_variance_m2_s2 = 0.0;    ///< of each axis of v_base_m_s

  bool attitude_valid = false;  ///< aligned to gravity
  bool velocity_valid = false;  ///< wheels present and fresh; else v_base_m_s is zero and x, y are constant
  bool standing_still = false;  ///< gyro, accelerometer and wheels agree on standstill
  bool may_stand = false;       ///< none of the sensors that there are contradicts standstill, wheels or not
};

/// Degrees of freedom that the ICP estimates, and the source of the height.
enum class Method : std::uint8_t {
  k6Dof,          ///< full pose
  k4Dof,          ///< x, y, z, yaw; roll and pitch from gravity
  k3Dof,          ///< x, y, yaw; roll and pitch from gravity, z from pressure (the paper's)
  k6DofAltitude,  ///< 6-DOF, altitude only in the prior
  k4DofAltitude,  ///< 4-DOF, altitude only in the prior
  kOdometry,      ///< dead reckoning alone, no ICP
  kAdaptive,  ///< full pose; gravity, gyro, wheels and altitude as information, the altimeter's bias as a state
};

/// Source of a pose.
enum class PoseMode : std::uint8_t {
  kRegistered,    ///< the ICP converged on this scan
  kPriorOnly,     ///< no scan, or the registration was rejected: dead reckoning from the last good pose
  kInitializing,  ///< bootstrap: first scans of the map
};

/// What the adaptive method knows of the altimeter: its bias against the map. All zero in other methods.
struct AltimeterState {
  double bias_m = 0.0;        ///< altimeter minus height: zones, doors, weather, drifts
  double bias_sd_m = 0.0;     ///< its standard deviation
  double innovation_m = 0.0;  ///< of the last update
  bool faulty = false;        ///< it departs from the map by more than zones, doors and weather explain
  DriftSuspect drifts = DriftSuspect::kNone;  ///< barometer that drifts now
  double drift_m_s = 0.0;                     ///< change of the bias while it drifts [m/s]
  double airflow_s2_m = 0.0;                  ///< learnt error by the robot's own wind: metres per (m/s)^2
  double airflow_sd_s2_m = 0.0;               ///< its standard deviation; 0: not estimated
};

/// Factor by which a measurement of the wheels is too small, and its standard deviation; sigma 0: not known.
struct WheelScale {
  double scale = 1.0;
  double sigma = 0.0;
};

/// What the adaptive method has found of mounts and wheels, and uses of the first.
struct MountState {
  bool found = false;
  bool yaw_found = false;
  /// Error of the lidar's configured mount: rotation vector in axes of base_link (roll, pitch, yaw) [rad], 1 sigma
  /// per axis, R_base_lidar(true) = exp(error^) R_base_lidar(configured).
  std::array<double, 3> error_rad{};
  std::array<double, 3> sigma_rad{};
  WheelScale wheel_distance;  ///< true distance = scale x the wheels'
  WheelScale wheel_turn;      ///< true turn = scale x the wheels': nominal over effective track width
};

/// What contradicts the registered poses: the robot is not where they say.
enum class LostReason : std::uint8_t {
  kNone,
  kTurn,          ///< they turn, and the gyro does not, or not as they do
  kTilt,          ///< they are tilted against gravity
  kMovingGround,  ///< the ground rises or sinks, and scans that show what moves with it cannot tell the height
};

/// Pose of base_link at the end of a scan (or between scans, with mode kPriorOnly).
struct PoseEstimate {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;  ///< of the scan; between scans, of the last one
  std::uint32_t session = 1;   ///< number of the map frame, 1 …; poses of two frames cannot be compared
  std::uint32_t map_moves =
      0;  ///< corrections of the map frame so far, see MapMove: the pose jumps with each
  PoseMode mode = PoseMode::kInitializing;
  Method method = Method::k3Dof;            ///< configured method
  Method effective_method = Method::k3Dof;  ///< method that ran: 3-DOF without any height runs as 4-DOF
  HeightSource height_source = HeightSource::kNone;
  bool degenerate =
      false;  ///< the scan leaves a free direction unconstrained: localisability.weak_count() > 0

  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();  ///< T_map_base = T_map_odom * T_odom_base
  /// Covariance of (x, y, z, roll, pitch, yaw) in the map frame, as REP-103 and nav_msgs order it.
  Matrix6d covariance = Matrix6d::Zero();

  std::uint32_t iterations = 0;
  std::uint32_t sampled_points = 0;  ///< points in the ICP
  std::uint32_t matched_pairs = 0;   ///< of them, with a correspondence in the last iteration
  double overlap = 0.0;              ///< matched_pairs / sampled_points, 0 … 1
  double residual_rms_m = 0.0;       ///< weighted point-to-plane rms
  Eigen::Vector3d smallest_eigenvalues =
      Eigen::Vector3d::Zero();  ///< of the information matrix per pair, ascending
  Localisability
      localisability;  ///< how well the scan holds each free direction, and who holds the weak ones
  AltimeterState altimeter;
  MountState mount;
  /// The robot is where it has been before: the pose takes up the drift of the way between.
  bool on_known_ground = false;
  bool for_map = true;  ///< the map may take the scan; false on moving ground and where the pose is doubtful
  /// Not kNone: the pose is dead reckoning from before the contradiction, in mode kPriorOnly, with a covariance that
  /// grows, and the map does not take the scan. Registered poses again where the place has been found again.
  LostReason lost = LostReason::kNone;
  std::int64_t lost_since_ns = 0;  ///< stamp of the first pose that says so; 0: not lost
  double registration_ms = 0.0;    ///< CPU time of the registration; filled by the thread that runs it
};

/// True for a pose that is none yet: before gravity is found (covariance 0), or of a continued run whose place no
/// scan has confirmed (it is only where the robot was).
[[nodiscard]] inline bool place_unknown(const PoseEstimate& pose) {
  constexpr double kKnownVarianceM2 = 25.0;  // poses in the map are known to centimetres
  const double variance_m2 = pose.covariance(0, 0);
  return pose.mode == PoseMode::kInitializing && (variance_m2 == 0.0 || variance_m2 > kKnownVarianceM2);
}

/// A deskewed scan in the base_link frame at the pose's time, thinned for the map.
struct RegisteredScan {
  static constexpr std::uint32_t kMaxPoints = 70'000;

  PoseEstimate pose;
  std::int64_t handed_over_ns = 0;  ///< hand-over to the map, robot clock; live runs only
  std::uint32_t point_count = 0;
  ScanPoint points[kMaxPoints];  // NOLINT(modernize-avoid-c-arrays): p_base, payload in shared memory

  RegisteredScan() {}  // NOLINT: user-written: loaning a chunk must not zero a megabyte
};

}  // namespace isobar
