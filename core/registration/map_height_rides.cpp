// SPDX-License-Identifier: BSD-3-Clause
// Rides of the owner of height: begun by the air, measured by RideMeter, ended by air and acceleration.
#include <algorithm>
#include <cmath>

#include "core/registration/map_height.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Largest gain of the altimeter on a ride that is no fault: another zone (4 Pa), and air of 17 K.
constexpr double kRideGainM = 0.35;
constexpr double kRideGainShare = 0.06;
// Longest time for which the acceleration contradicts the end of a ride.
constexpr double kStopDoubtS = 10.0;

}  // namespace

void MapHeight::watch_ride(const Prior& prior, bool stands) {
  if (unseen_start_) {
    if (any_) risen_m_ += prior.height_m - last_.height_m;
    unseen_start_ = prior.ground_moves;
    if (!unseen_start_) widen(kMap, prior.height_variance_m2);
    unconfirmed_m2_ = prior.height_variance_m2;
    return;
  }
  if (prior.ground_moves && stands && !ride_.riding()) {
    // A run that goes on in a cabin, or a gap: the speed is not known.
    unseen_start_ = !ride_.remembers_start();
    if (unseen_start_) return;
    ride_.begin();
    taken_m_ = waited_s_ = 0.0;
  }
  if (!prior.ground_moves && ride_.riding()) {
    waited_s_ += any_ ? seconds_between(last_.stamp_ns, prior.stamp_ns) : 0.0;
    // A cabin that creeps to its floor, or a stop that only the air has seen.
    if (ride_.may_have_stopped() || !stands || waited_s_ > kStopDoubtS) end_ride();
  }
  if (ride_.riding()) take_rise();
}

void MapHeight::take_rise() {
  risen_m_ += ride_.risen_m() - taken_m_;
  taken_m_ = ride_.risen_m();
}

// The altimeter at a floor of unknown ventilation says nothing of the ride's error that RideMeter has not used: what the
// height errs by, the bias errs by.
void MapHeight::end_ride() {
  ride_.end();
  take_rise();
  const double variance_m2 = ride_.variance_m2();
  unconfirmed_m2_ += variance_m2;
  const double gain_m = ride_.altimeter_gain_m();
  const double explained_m = kRideGainM + kRideGainShare * std::abs(ride_.risen_m());
  x_[kBias] += gain_m;
  floor_bias_m_ += std::clamp(gain_m, -explained_m, explained_m);
  Vector common = Vector::Zero();
  common[kMap] = common[kBias] = 1.0;
  for (Matrix* P : {&P_, &with_start_}) *P += variance_m2 * common * common.transpose();
}

double MapHeight::take_risen_m() {
  const double risen_m = risen_m_;
  risen_m_ = 0.0;
  return risen_m;
}

}  // namespace isobar
