// SPDX-License-Identifier: BSD-3-Clause
#include "config/config_change.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"

namespace isobar::test::test_config_change {

namespace {

using Keys = std::vector<std::string>;

Apply as_in_the_table(const Setting& setting) { return setting.apply; }

ConfigChange change(const std::string& from, const std::string& to) {
  return change_to(parse_config(from, "a.toml"), parse_config(to, "b.toml"), as_in_the_table, "b.toml");
}

}  // namespace

TEST_CASE("changed keys are sorted by the time of their effect, and only those due now change") {
  const ConfigChange found =
      change("", "map.radius_m = 50\nmap.cell_m = 0.3\nregistration.min_pairs = 50\nmethod = \"4dof\"\n");
  CHECK(found.live == Keys{"map.radius_m"});
  CHECK(found.stage == Keys{"method", "registration.min_pairs"});
  CHECK(found.at_start == Keys{"map.cell_m"});
  CHECK(found.running.map.radius_m == 50.0);
  CHECK(found.running.method == Method::k4Dof);
  CHECK(found.running.map.cell_m == Config{}.map.cell_m);
  CHECK(found.concerns("registration."));
  CHECK(found.concerns("method"));
  CHECK_FALSE(found.concerns("lidar."));
  CHECK_FALSE(found.concerns("map.cell_m"));
}

TEST_CASE("equal configurations change nothing; a key that goes takes its default again") {
  CHECK(change("map.radius_m = 50\n", "[map]\nradius_m = 50.0\n").nothing_now());
  CHECK(change("map.radius_m = 50\n", "").running.map.radius_m == Config{}.map.radius_m);
}

TEST_CASE("every value can be copied, of whatever type") {
  const auto all_live = [](const Setting& /*setting*/) { return Apply::kLive; };
  const std::string text =
      "role = \"base-station\"\nrealtime.estimator_cpus = [1]\nrealtime.enabled = true\n"
      "barometer.compensation.coefficients = [1.0]\nbarometer.compensation.model = \"none\"\n"
      "dds.base_station = \"roof\"\ninput.port = 7\naltimeter.spike_confirmations = 6\n";
  Config next = parse_config("", "a.toml");
  try {
    next = parse_config(text, "b.toml");
  } catch (const ConfigError&) {
    next.role = Role::kBaseStation;
  }
  CHECK(show_config(change_to(Config{}, next, all_live, "b.toml").running) == show_config(next));
}

TEST_CASE("values that would break a rule beside those that wait for the next start are refused") {
  // registration.* is rebuilt at once, lidar.port and input.port wait: only mixes are at stake.
  const auto only_lowest = [](const Setting& setting) {
    return setting.key == "registration.min_range_m" ? Apply::kLive : Apply::kRestart;
  };
  const Config running = parse_config("registration.max_range_m = 5\n", "a.toml");
  const Config next = parse_config("registration.min_range_m = 5\n", "b.toml");
  CHECK_THROWS_WITH_AS(change_to(running, next, only_lowest, "b.toml"),
                       doctest::Contains("b.toml: beside the running values, which change at the next start: "
                                         "registration.min_range_m: must be below"),
                       ConfigError);
}

}  // namespace isobar::test::test_config_change
