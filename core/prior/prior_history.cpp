// SPDX-License-Identifier: BSD-3-Clause
#include "core/prior/prior_history.hpp"

#include <algorithm>

#include "core/pose_carrying.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Longest gap between two priors that counts as dense: a constant twist is still a good model of it.
constexpr std::int64_t kLongestBlindNs = 500'000'000;

double lerp(double a, double b, double f) { return a + f * (b - a); }

Eigen::Vector3d lerp(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double f) { return a + f * (b - a); }

// Prior at `stamp_ns` between two priors.
Prior interpolate(const Prior& before, const Prior& after, std::int64_t stamp_ns) {
  const std::int64_t span_ns = after.stamp_ns - before.stamp_ns;
  const double f =
      span_ns > 0 ? static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(span_ns) : 1.0;
  Prior out = after;
  out.stamp_ns = stamp_ns;
  const Eigen::Quaterniond q_before(before.T_odom_base.linear());
  const Eigen::Quaterniond q_after(after.T_odom_base.linear());
  out.T_odom_base.linear() = q_before.slerp(f, q_after).normalized().toRotationMatrix();
  out.T_odom_base.translation() = lerp(Eigen::Vector3d(before.T_odom_base.translation()),
                                       Eigen::Vector3d(after.T_odom_base.translation()), f);
  out.height_m = lerp(before.height_m, after.height_m, f);
  out.height_variance_m2 = lerp(before.height_variance_m2, after.height_variance_m2, f);
  out.height_source = std::max(before.height_source, after.height_source);
  out.v_base_m_s = lerp(before.v_base_m_s, after.v_base_m_s, f);
  out.w_base_rad_s = lerp(before.w_base_rad_s, after.w_base_rad_s, f);
  out.roll_pitch_variance_rad2 = lerp(before.roll_pitch_variance_rad2, after.roll_pitch_variance_rad2, f);
  out.yaw_rate_variance_rad2_s2 = lerp(before.yaw_rate_variance_rad2_s2, after.yaw_rate_variance_rad2_s2, f);
  out.yaw_bias_variance_rad2_s2 = lerp(before.yaw_bias_variance_rad2_s2, after.yaw_bias_variance_rad2_s2, f);
  out.velocity_variance_m2_s2 = lerp(before.velocity_variance_m2_s2, after.velocity_variance_m2_s2, f);
  out.attitude_valid = before.attitude_valid && after.attitude_valid;
  out.velocity_valid = before.velocity_valid && after.velocity_valid;
  out.standing_still = before.standing_still && after.standing_still;
  out.may_stand = before.may_stand && after.may_stand;
  return out;
}

// Prior carried on to `stamp_ns` at constant twist. The height's variance grows with the velocity's.
Prior extrapolate(const Prior& from, std::int64_t stamp_ns, double height_rate_m_s) {
  const double dt_s = seconds_between(from.stamp_ns, stamp_ns);
  const Eigen::Vector3d half_turn_rad = from.w_base_rad_s * (0.5 * dt_s);
  const Eigen::Quaterniond half_turn = exp_so3(half_turn_rad);
  Prior out = from;
  out.stamp_ns = stamp_ns;
  out.T_odom_base.translation() +=
      midpoint_step(Eigen::Quaterniond(from.T_odom_base.linear()), half_turn_rad, from.v_base_m_s * dt_s);
  out.T_odom_base.linear() =
      from.T_odom_base.linear() * (half_turn * half_turn).normalized().toRotationMatrix();
  out.height_m += height_rate_m_s * dt_s;
  out.height_variance_m2 += dt_s * dt_s * from.velocity_variance_m2_s2;
  return out;
}

}  // namespace

PriorHistory::PriorHistory(std::size_t capacity, std::int64_t max_extrapolation_ns)
    : ring_(std::max<std::size_t>(capacity, 2)),
      max_extrapolation_ns_(std::max<std::int64_t>(max_extrapolation_ns, 0)) {}

void PriorHistory::add(const Prior& prior) {
  if (count_ > 0 && prior.stamp_ns <= newest().stamp_ns) return;
  if (count_ < ring_.size()) {
    ring_[(first_ + count_) % ring_.size()] = prior;
    ++count_;
    return;
  }
  ring_[first_] = prior;
  first_ = (first_ + 1) % ring_.size();
}

double PriorHistory::height_rate_m_s() const {
  // Mean over 50 ms: single steps contain the barometer's corrections.
  constexpr std::int64_t kSpanNs = 50'000'000;
  for (std::size_t back = 2; back <= count_; ++back) {
    const Prior& before = nth(count_ - back);
    const std::int64_t span_ns = newest().stamp_ns - before.stamp_ns;
    if (span_ns >= kSpanNs || back == count_) {
      return (newest().height_m - before.height_m) / seconds_between(before.stamp_ns, newest().stamp_ns);
    }
  }
  return 0.0;
}

bool PriorHistory::covers(std::int64_t stamp_ns) const {
  return count_ > 0 && stamp_ns >= oldest().stamp_ns && stamp_ns - newest().stamp_ns <= max_extrapolation_ns_;
}

// Binary search: the first prior later than stamp_ns, 1 … count_ - 1. Needs oldest <= stamp_ns < newest.
std::size_t PriorHistory::first_after(std::int64_t stamp_ns) const {
  std::size_t low = 1;
  std::size_t high = count_ - 1;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (nth(middle).stamp_ns > stamp_ns) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

bool PriorHistory::dense_at(std::int64_t stamp_ns) const {
  if (!covers(stamp_ns)) return false;
  if (stamp_ns >= newest().stamp_ns) return true;
  const std::size_t after = first_after(stamp_ns);
  return nth(after).stamp_ns - nth(after - 1).stamp_ns <= kLongestBlindNs;
}

bool PriorHistory::at(std::int64_t stamp_ns, Prior& out) const {
  if (!covers(stamp_ns)) return false;
  if (stamp_ns >= newest().stamp_ns) {
    out = extrapolate(newest(), stamp_ns, height_rate_m_s());
    return true;
  }
  const std::size_t after = first_after(stamp_ns);
  out = interpolate(nth(after - 1), nth(after), stamp_ns);
  return true;
}

}  // namespace isobar
