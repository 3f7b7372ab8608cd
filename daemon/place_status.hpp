// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace isobar {

/// What the search of the place in the whole map is doing.
enum class PlaceState : std::uint8_t {
  kIdle,        ///< the robot knows its place, or there is no map to search
  kCollecting,  ///< scans are gathered
  kBlind,       ///< the scans show too little for any place to be told
  kAmbiguous,   ///< several places fit: the robot must drive on
  kUnknown,     ///< no place fits
  kTold,        ///< the place that was found is tried by the registration
  kGivenUp,     ///< a new map frame begins
};

/// A place that fits the scans, among others.
struct PlaceHypothesis {
  std::array<double, 3> p_map_m{};
  double yaw_rad = 0.0;
  double weight = 0.0;  ///< probability among the hypotheses, 0 … 1
};

/// Status of the search: plain values, trivially copyable.
struct PlaceStatus {
  static constexpr std::size_t kMostHypotheses = 16;

  PlaceState state = PlaceState::kIdle;
  bool lost = false;  ///< searched because the robot is lost
  bool carried =
      false;  ///< searched because it may have been carried away; neither: because it has just started
  bool height_is_known =
      false;  ///< by air pressure in the datum of the map; else every level of ground is searched
  std::uint64_t searches = 0;  ///< since the start
  std::uint64_t refused = 0;   ///< places found that the registration did not confirm
  std::uint64_t given_up = 0;  ///< times that a new map frame was asked for
  std::uint64_t found = 0;     ///< places found
  double fit = 0.0;            ///< share of the scans that the best place explains, 0 … 1
  double search_s = 0.0;       ///< CPU time of the last search
  double waited_s = 0.0;       ///< since the place is unknown
  double driven_m = 0.0;       ///< the same, by odometry
  std::uint32_t hypothesis_count = 0;
  std::array<PlaceHypothesis, kMostHypotheses> hypotheses{};  ///< of kAmbiguous, the likeliest first
};

/// One sentence about the search; empty when it is idle.
[[nodiscard]] std::string place_text(const PlaceStatus& status);

}  // namespace isobar
