// SPDX-License-Identifier: BSD-3-Clause
#include "core/mounts/gyro_turn.hpp"

#include <algorithm>
#include <cstddef>

#include "core/so3.hpp"
#include "core/stamp.hpp"

namespace isobar {

namespace {

// Longest step between two priors [s]: a vibrating robot turns unseen in a longer one.
constexpr double kLongestPriorStepS = 0.1;

// Index of the first prior after `stamp_ns`, searched from the newest: scans end close to it.
std::size_t first_prior_after(const PriorHistory& history, std::int64_t stamp_ns) {
  std::size_t index = history.size();
  while (index > 0 && history[index - 1].stamp_ns > stamp_ns) --index;
  return index;
}

}  // namespace

bool gyro_turn(const PriorHistory& history, std::int64_t from_ns, std::int64_t to_ns,
               Eigen::Quaterniond& turn) {
  if (history.empty() || to_ns < from_ns || history.newest().stamp_ns < to_ns) return false;
  std::size_t index = first_prior_after(history, from_ns);
  if (index == 0) return false;
  Eigen::Quaterniond sum = Eigen::Quaterniond::Identity();
  for (std::int64_t at_ns = from_ns; at_ns < to_ns; ++index) {
    const Prior& before = history[index - 1];
    const Prior& after = history[index];
    const bool known = before.attitude_valid && after.attitude_valid &&
                       seconds_between(before.stamp_ns, after.stamp_ns) <= kLongestPriorStepS;
    if (!known) return false;
    const std::int64_t end_ns = std::min(after.stamp_ns, to_ns);
    sum = sum * exp_so3(0.5 * seconds_between(at_ns, end_ns) * (before.w_base_rad_s + after.w_base_rad_s));
    at_ns = end_ns;
  }
  turn = sum.normalized();
  return true;
}

}  // namespace isobar
