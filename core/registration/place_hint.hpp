// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/name_table.hpp"

namespace isobar {

/// Where somebody says that the robot is: plain values, all finite.
struct PlaceHint {
  std::uint32_t session = 0;                          ///< number of the map frame; 0: the one in force
  Eigen::Vector2d p_map_m = Eigen::Vector2d::Zero();  ///< x and y of base_link
  bool has_z = false;
  double z_m = 0.0;        ///< of base_link, if has_z
  double z_sigma_m = 0.0;  ///< 1 sigma
  bool z_is_sure = false;  ///< z is of a scan that matched there: it counts more than the altimeter
  double yaw_rad = 0.0;
  double sigma_m = 0.0;    ///< of x and y, 1 sigma; 0: not stated
  double sigma_rad = 0.0;  ///< of yaw, 1 sigma; 0: not stated
};

/// What became of a hint.
enum class HintOutcome : std::uint8_t {
  kNone,         ///< none was given
  kTrying,       ///< hypotheses around it are being matched
  kFound,        ///< the robot is there, and goes on from there
  kConfirmed,    ///< the robot is there, and knew it
  kNoMatch,      ///< no hypothesis matches
  kPresentFits,  ///< the scans match where the robot believes to be as well
  kOtherFrame,   ///< it is of another map frame
  kOtherHeight,  ///< the altimeter says another height
  kNoMap,        ///< there is no map yet to match
  kNoScan,       ///< no scan came that could be judged
};

inline constexpr NameTable<HintOutcome, 10> kHintOutcomeTexts{{{
    {HintOutcome::kNone, "no hint was given"},
    {HintOutcome::kTrying, "tried: hypotheses around it are being matched"},
    {HintOutcome::kFound, "taken: the scans match there"},
    {HintOutcome::kConfirmed, "confirmed: the robot is there, and knew it"},
    {HintOutcome::kNoMatch, "refused: no hypothesis around it matches"},
    {HintOutcome::kPresentFits, "refused: the scans match where the robot is as well as there"},
    {HintOutcome::kOtherFrame, "refused: it is of another map frame"},
    {HintOutcome::kOtherHeight, "refused: the altimeter says another height"},
    {HintOutcome::kNoMap, "refused: there is no map yet to match"},
    {HintOutcome::kNoScan, "refused: no scan came that could be judged"},
}}};

/// The last hint: plain values, trivially copyable.
struct HintReport {
  std::uint64_t given = 0;  ///< hints so far
  HintOutcome outcome = HintOutcome::kNone;
  std::int64_t stamp_ns = 0;  ///< of the scan with which the outcome was known, or the trial begun
  double radius_m = 0.0;      ///< of the hypotheses around the hint
  double distance_m = 0.0;    ///< horizontal, of the hint from where the robot believed to be

  [[nodiscard]] bool is_decided() const noexcept {
    return outcome != HintOutcome::kNone && outcome != HintOutcome::kTrying;
  }
};

}  // namespace isobar
