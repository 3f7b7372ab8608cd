// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/geometry.hpp"
#include "core/names.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {

namespace {

// "along 35 deg" of the map, "z", "yaw": the largest part of the direction.
std::string name_of(const Direction& direction) {
  static constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "roll", "pitch", "yaw"};
  const auto smaller = [](float a, float b) { return std::abs(a) < std::abs(b); };
  const auto largest = static_cast<std::size_t>(
      std::max_element(direction.axis.begin(), direction.axis.end(), smaller) - direction.axis.begin());
  if (largest > 1) return kAxes[largest];
  const double heading_deg =
      std::atan2(static_cast<double>(direction.axis[1]), static_cast<double>(direction.axis[0])) / kRadPerDeg;
  // A direction has no sense: -90 ... 90 deg.
  return fmt::format("along {:.0f} deg", std::remainder(heading_deg, 180.0));
}

}  // namespace

void add_localisability(ipc::HealthReport& report, const Localisability& localisability) {
  if (localisability.count == 0) return;
  const auto weak = localisability.weak_count();
  const double weakest = static_cast<double>(localisability.directions[0].strength);
  bool held = true;
  std::string text = weak == 0 ? "the scans hold every direction" : "";
  for (std::size_t i = 0; i < weak; ++i) {
    const Direction& direction = localisability.directions[i];
    held = held && direction.holder != Holder::kMotion;
    text +=
        fmt::format("{}{}: {:.0f} % of localisability, held by {}", i == 0 ? "" : "; ", name_of(direction),
                    100.0 * static_cast<double>(direction.strength), kHolderNames.name(direction.holder));
  }
  if (!held) text += "; nothing measures it: wheels, or surfaces across it, would";
  add_entry(report, "registration/localisability", held ? ipc::HealthLevel::kOk : ipc::HealthLevel::kWarning,
            text, weakest);
}

}  // namespace isobar
