// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scenario_list.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/nearest_word.hpp"
#include "simulation/simulate.hpp"

namespace isobar::simulation {

namespace {

constexpr std::array kEntries{
    ScenarioEntry{"three-floors", "tracked robot, 100 m of corridors on each of three floors, two staircases",
                  make_three_floors},
    ScenarioEntry{"elevator", "tracked robot, third floor, elevator to the ground floor, a ramp and back",
                  make_elevator},
    ScenarioEntry{"moulin", "hanging sphere, lowered into a shaft of ice and pulled up again", make_moulin},
    ScenarioEntry{"stairs-demo", "tracked robot, a corridor, down a staircase to the next floor and on",
                  make_stairs_demo},
    ScenarioEntry{"round-trip", "tracked robot, three floors up and the same way back to the start",
                  make_round_trip},
    ScenarioEntry{"four-floors",
                  "tracked robot, 40 minutes on four floors of equal plan, stairs and an elevator",
                  make_four_floors, true},
    ScenarioEntry{"hill",
                  "wheeled robot, a round of 600 m over a hill with trees and bushes, in gusts of wind",
                  make_hill},
    ScenarioEntry{"parking", "wheeled robot, up the helical ramp of a parking garage, 3 or 4 levels",
                  make_parking},
    ScenarioEntry{"stairs", "tracked robot, three storeys of stairs up and down, with level lobbies",
                  make_stairs},
    ScenarioEntry{"corridor", "tracked robot, 300 m of bare corridor, 120 s without base station",
                  make_corridor},
    ScenarioEntry{"city", "wheeled robot, 2 km of hilly streets with traffic at 6 to 10 m/s", make_city},
    ScenarioEntry{"city-10km", "the same over 10 km, nearly all of it through streets never seen before",
                  make_city_10km, true},
    ScenarioEntry{"city-hour", "the same for an hour, 20 km: for runs in real time", make_city_hour, true},
};

}  // namespace

const ScenarioEntry& find_scenario(const std::string& name) {
  const auto* found = std::find_if(kEntries.begin(), kEntries.end(),
                                   [&](const ScenarioEntry& entry) { return name == entry.name; });
  if (found != kEntries.end()) return *found;
  std::string all;
  std::vector<std::string> names;
  for (const ScenarioEntry& entry : kEntries) {
    names.emplace_back(entry.name);
    all += (all.empty() ? "" : ", ") + names.back();
  }
  throw UsageError("unknown scenario '" + name + "'" + did_you_mean(name, names) +
                   "; known scenarios: " + all);
}

std::vector<ScenarioInfo> scenarios() {
  std::vector<ScenarioInfo> infos;
  infos.reserve(kEntries.size());
  for (const ScenarioEntry& entry : kEntries) infos.push_back({entry.name, entry.description, entry.is_long});
  return infos;
}

}  // namespace isobar::simulation
