// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/dead_reckoning_error.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Walks of the slip of wheels [m/sqrt(m)] and of their heading on uneven ground [rad/sqrt(m)].
constexpr double kSlipMSqrtM = 0.015;
constexpr double kSlipRadSqrtM = 5e-4;
// Least error of a gyro's rate that lasts: its bias changes with temperature and turns [rad/s]; and the time over which
// Prior's variance of the rate averages its noise [s].
constexpr double kLeastBiasRadS = 2e-4;
constexpr double kRateMeanS = 0.1;
// Turn rate of a robot whose IMU is silent; largest acceleration of one without wheels, and correlation time of its
// velocity.
constexpr double kSilentRateRadS = 0.5;
constexpr double kFreeAccelerationMS2 = 3.0;
constexpr double kFreeCorrelationS = 3.0;
// Time for which the last velocity is the best guess of the present one [s].
constexpr double kVelocityMemoryS = 2.0;

enum Constant { kScaleConstant, kRateConstant, kTiltConstant };

}  // namespace

void DeadReckoningError::restart(const Eigen::Vector3d& v_map_m_s) {
  *this = {};
  v_map_m_s_ = v_map_m_s;
}

void DeadReckoningError::move(const Prior& prior, const UnseenStep& step) {
  error_.move(step.step_m);
  if (!prior.standing_still) turn(prior, step.dt_s);
  if (prior.velocity_valid) {
    roll(step);
  } else {
    drift_freely(std::sqrt(std::max(prior.velocity_variance_m2_s2, 0.0)), step.dt_s);
  }
  way_m_ += step.step_m.norm();
  time_s_ += step.dt_s;
}

void DeadReckoningError::turn(const Prior& prior, double dt_s) {
  const double bias_rad_s =
      std::max({std::sqrt(std::max(prior.yaw_bias_variance_rad2_s2, 0.0)), kLeastBiasRadS,
                prior.attitude_valid || prior.velocity_valid ? 0.0 : kSilentRateRadS});
  error_.constants(5, kRateConstant) += bias_rad_s * dt_s;
  const double noise = std::max(prior.yaw_rate_variance_rad2_s2 - prior.yaw_bias_variance_rad2_s2, 0.0);
  error_.random(5, 5) += noise * kRateMeanS * dt_s;
}

void DeadReckoningError::roll(const UnseenStep& step) {
  const double way_m = step.step_m.norm();
  error_.constants.col(kScaleConstant).head<3>() += kWheelScaleError * step.step_m;
  const Eigen::Vector3d pitch_rad = step.tilt_rad * step.R_map_base.col(1);
  error_.constants.col(kTiltConstant).head<3>() += pitch_rad.cross(step.step_m);
  error_.random.diagonal().head<3>().array() += squared(kSlipMSqrtM) * way_m;
  error_.random(5, 5) += squared(kSlipRadSqrtM) * way_m;
}

// At first the velocity is that of the last scans, and errs by what an acceleration has changed. Later it is unknown: that
// of a robot that hangs or is pushed changes its direction, that of one whose wheels have fallen silent may go on.
void DeadReckoningError::drift_freely(double velocity_sigma_m_s, double dt_s) {
  free_s_ += dt_s;
  const double unknown_m_s = std::min(velocity_sigma_m_s, kFreeAccelerationMS2 * free_s_);
  free_variance_m2_ += 2.0 * squared(unknown_m_s) * std::min(free_s_, kFreeCorrelationS) * dt_s;
  going_on_m_ += -std::expm1(-free_s_ / kVelocityMemoryS) * v_map_m_s_.norm() * dt_s;
}

Matrix6d DeadReckoningError::covariance() const {
  Matrix6d covariance = error_.covariance();
  covariance.diagonal().head<3>().array() += free_variance_m2_ + squared(going_on_m_);
  // An angle that is not known at all.
  constexpr double kAnyRad = 3.0;
  const double factor = std::min(1.0, kAnyRad / std::sqrt(std::max(covariance(5, 5), 1e-12)));
  covariance.row(5) *= factor;
  covariance.col(5) *= factor;
  return covariance;
}

}  // namespace isobar
