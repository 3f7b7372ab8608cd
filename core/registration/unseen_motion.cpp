// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/unseen_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/short_pause.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Longest way and turn that are predicted: beyond them the motion has changed.
constexpr double kMostUnseenM = 30.0;
constexpr double kMostUnseenRad = 1.6;
// Longest step between two priors: over a longer one the IMU was silent.
constexpr double kLongestStepS = 0.5;

/// First prior with wheels; null without one.
const Prior* first_on_wheels(const PriorHistory& priors) {
  for (std::size_t i = 0; i < priors.size(); ++i) {
    if (priors[i].velocity_valid) return &priors[i];
  }
  return nullptr;
}

/// Planar motion in the map from the place on. Before the wheels are read, the speed of a robot on wheels changes
/// evenly from the last one to that of the wheels, along its own axes; a robot that hangs or flies goes straight on.
class PlanarMotion {
 public:
  PlanarMotion(const KnownPlace& place, const Prior* on_wheels)
      : on_wheels_(on_wheels),
        v_map_m_s_(place.v_map_m_s),
        place_yaw_rad_(yaw_of(place.T_map_base.linear())) {
    if (on_wheels_ == nullptr) return;
    unseen_s_ = seconds_between(place.stamp_ns, on_wheels_->stamp_ns);
    v_base_m_s_ = rotation_about_z(-place_yaw_rad_) * place.v_map_m_s;
  }

  void turn(double angle_rad) { yaw_rad_ += angle_rad; }
  void go_unseen(double seconds) {
    passed_s_ += 0.5 * seconds;  // midpoint rule
    const Eigen::Vector3d step = unseen_velocity() * seconds;
    passed_s_ += 0.5 * seconds;
    const double way_m = step.head<2>().norm();
    if (unseen_m_ + way_m > kMostUnseenM) return;
    p_map_ += step;
    unseen_m_ += way_m;
  }
  void roll(const Eigen::Vector3d& v_base_m_s, double seconds) { p_map_ += in_map(v_base_m_s) * seconds; }

  [[nodiscard]] const Eigen::Vector3d& p_map() const { return p_map_; }
  [[nodiscard]] double yaw_rad() const { return yaw_rad_; }
  [[nodiscard]] double unseen_m() const { return unseen_m_; }

 private:
  [[nodiscard]] Eigen::Vector3d in_map(const Eigen::Vector3d& v_base) const {
    return rotation_about_z(place_yaw_rad_ + yaw_rad_) * v_base;
  }
  [[nodiscard]] Eigen::Vector3d unseen_velocity() const {
    if (on_wheels_ == nullptr) return v_map_m_s_;
    const double share = std::clamp(passed_s_ / std::max(unseen_s_, 1e-3), 0.0, 1.0);
    const Eigen::Vector2d after = on_wheels_->v_base_m_s.head<2>();
    Eigen::Vector3d v_base = v_base_m_s_;
    v_base.head<2>() += share * (after - v_base.head<2>());
    return in_map(v_base);
  }

  const Prior* on_wheels_;
  Eigen::Vector3d v_map_m_s_;
  Eigen::Vector3d v_base_m_s_ = Eigen::Vector3d::Zero();
  double place_yaw_rad_;
  double unseen_s_ = 0.0;
  double passed_s_ = 0.0;
  Eigen::Vector3d p_map_ = Eigen::Vector3d::Zero();
  double yaw_rad_ = 0.0;
  double unseen_m_ = 0.0;
};

}  // namespace

ExpectedPlace expected_place(const KnownPlace& place, const PriorHistory& priors) {
  const bool short_pause = is_short_pause(seconds_between(place.stamp_ns, priors.newest().stamp_ns));
  ExpectedPlace expected;
  PlanarMotion motion(place, first_on_wheels(priors));
  if (short_pause) {
    const double gap_s = std::max(0.0, seconds_between(place.stamp_ns, priors.oldest().stamp_ns));
    const double turn_rad = std::clamp(place.yaw_rate_rad_s * gap_s, -kMostUnseenRad, kMostUnseenRad);
    motion.turn(0.5 * turn_rad);  // midpoint rule
    motion.go_unseen(gap_s);
    motion.turn(0.5 * turn_rad);
    expected.unseen_rad = std::abs(turn_rad);
  }
  for (std::size_t i = 1; i < priors.size(); ++i) {
    const Prior& prior = priors[i];
    const double dt_s = seconds_between(priors[i - 1].stamp_ns, prior.stamp_ns);
    if (dt_s > kLongestStepS) continue;
    motion.turn(prior.w_base_rad_s.z() * dt_s);
    if (prior.velocity_valid) {
      motion.roll(prior.v_base_m_s, dt_s);
    } else if (short_pause) {
      motion.go_unseen(dt_s);
    }
  }
  expected.T_map_base.linear() = rotation_about_z(motion.yaw_rad()) * place.T_map_base.linear();
  expected.T_map_base.translation() = place.T_map_base.translation() + motion.p_map();
  expected.unseen_m = motion.unseen_m();
  expected.stood = short_pause && priors.newest().velocity_valid && expected.unseen_m < kStoodM &&
                   expected.unseen_rad < kStoodRad;
  return expected;
}

}  // namespace isobar
