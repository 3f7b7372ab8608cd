// SPDX-License-Identifier: BSD-3-Clause
// Unit and sign of turn rates.
#pragma once

#include "core/contradictions/finding.hpp"
#include "core/contradictions/motion_comparison.hpp"

namespace isobar {

/// Comparisons of each two of the three sensors that feel a turn; windows 0 where one is missing.
struct TurnComparisons {
  TurnRatio gyro_by_scans;
  TurnRatio gyro_by_wheels;
  TurnRatio wheels_by_scans;
};

/// Meaning of a ratio; unclear: too little turn, or none of the others.
enum class TurnVerdict : std::uint8_t { kUnclear, kAgree, kOpposite, kDegrees, kRadiansTwice };

/// Agree: 0.5 … 2, skid steering slips by a third. Opposite: -0.5 … -2 in three seconds of turning, 0.7 rad. Degrees: 40 …
/// 80 around 57.3, in two seconds and 0.3 rad, as no other fault makes it; its inverse as a conversion too many.
TurnVerdict verdict_on(const TurnRatio& turn);

/// Adds what is wrong with the turn rates. Of a sign, two of the three must be compared with the third; where only two
/// turn, the gyro against the other is blamed, for the wheels or the scans see what happened.
/// @param points_down gravity is down by the configured mount: the gyro must then turn the wrong way
void add_turn_findings(const TurnComparisons& turns, bool points_down, Findings& findings);

}  // namespace isobar
