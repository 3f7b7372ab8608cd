// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/place_status.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/geometry.hpp"

namespace isobar {

namespace {

// Hypotheses that are written out.
constexpr std::size_t kShown = 3;

std::string text_of(const PlaceHypothesis& one) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.0f %% at (%.1f, %.1f, %.1f) m, %.0f deg", 100.0 * one.weight,
                one.p_map_m[0], one.p_map_m[1], one.p_map_m[2], one.yaw_rad / kRadPerDeg);
  return text.data();
}

std::string ambiguous_text(const PlaceStatus& status) {
  std::string text =
      std::to_string(status.hypothesis_count) + " places of the map fit, drive on to tell them apart: ";
  const std::size_t shown = std::min<std::size_t>(status.hypothesis_count, kShown);
  for (std::size_t i = 0; i < shown; ++i) text += (i > 0 ? "; " : "") + text_of(status.hypotheses.at(i));
  return text + (shown < status.hypothesis_count ? "; …" : "");
}

}  // namespace

std::string place_text(const PlaceStatus& status) {
  const std::string height =
      status.height_is_known ? "" : "; its height is not known in this map, all floors are searched";
  if (status.carried) return "what the robot sees has changed at once while it stood: its place is searched";
  switch (status.state) {
    case PlaceState::kIdle:
      return {};
    case PlaceState::kCollecting:
      return "scans are gathered to find the place in the map" + height;
    case PlaceState::kBlind:
      return "the scans show too little to find the place in the map" + height;
    case PlaceState::kAmbiguous:
      return ambiguous_text(status) + height;
    case PlaceState::kUnknown:
      return "no place of the map fits what the robot sees" + height;
    case PlaceState::kTold:
      return "a place of the map fits; the next scans must confirm it" + height;
    case PlaceState::kGivenUp:
      return "the place is none of the map; a new map frame begins";
  }
  return {};
}

}  // namespace isobar
