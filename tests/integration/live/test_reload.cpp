// SPDX-License-Identifier: BSD-3-Clause
// isobard whose configuration is changed while it runs: poses go on, bad files change nothing.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "config/config_layer.hpp"
#include "tests/integration/live/tap.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_reload {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::check_steady;
using test::ChildProcess;
using test::Drive;
using test::Tap;

/// The drive, and the folder conf.d beside its configuration.
class Site {
 public:
  Site() { std::filesystem::create_directories(drive.folder / "conf.d"); }

  Drive drive{"reload", "40"};

  /// Writes conf.d/50-site.toml, by rename or in place.
  void push(const std::string& text, bool by_rename) const {
    const std::filesystem::path file = drive.folder / "conf.d/50-site.toml";
    const std::filesystem::path written = by_rename ? drive.folder / "conf.d/50-site.toml.new" : file;
    std::ofstream(written, std::ios::binary) << text;
    if (by_rename) std::filesystem::rename(written, file);
  }
  [[nodiscard]] std::string hash() const { return config_hash(load_layers(drive.config).config); }
};

std::string message(const Tap& tap, const char* name) {
  const ipc::HealthEntry* entry = tap.entry(name);
  return entry == nullptr ? "" : entry->message;
}

/// Gathers until the message of an entry contains `words`.
bool comes(Tap& tap, const char* name, const std::string& words) {
  for (int i = 0; i < 80; ++i) {
    tap.gather(100ms);
    if (message(tap, name).find(words) != std::string::npos) return true;
  }
  MESSAGE(name << ": " << message(tap, name) << ", wanted: " << words);
  return false;
}

/// Poses have no gap over 200 ms: at 10 Hz no scan is without a pose but one whose end is lost.
void check_no_gap(const Tap& tap) {
  REQUIRE(tap.poses.size() > 10);
  for (std::size_t i = 1; i < tap.poses.size(); ++i) {
    CHECK(tap.poses[i].estimate.stamp_ns - tap.poses[i - 1].estimate.stamp_ns <= 200'000'000);
  }
  check_steady(tap.poses, 0.1);
}

void many_reloads(const ChildProcess& isobard, const Site& site, Tap& tap) {
  tap.forget();
  for (int i = 0; i < 30; ++i) {
    site.push("registration.max_iterations = " + std::to_string(12 + i % 3) + "\nlidar.min_range_m = 0.3" +
                  std::to_string(i % 3) + "\nmap.radius_m = 7" + std::to_string(i % 3) +
                  "\nlimits.imu_gap_s = 0.1" + std::to_string(i % 3) + "\n",
              i % 2 == 0);
    isobard.signal(SIGHUP);
    tap.gather(100ms);
  }
  CHECK(comes(tap, "configuration", "hash " + site.hash()));
  check_no_gap(tap);
  CHECK(tap.poses.back().estimate.mode == PoseMode::kRegistered);
}

void refused(const Site& site, Tap& tap) {
  tap.forget();
  const std::string before = site.hash();
  site.push("registration.max_iterations = 13\nmap.radius_m = 7\n", true);
  CHECK(comes(tap, "configuration/refused", "50-site.toml:2:16: map.radius_m: must be a number within 20"));
  CHECK(message(tap, "configuration").find("hash " + before) != std::string::npos);
  CHECK(message(tap, "configuration").find("1 reloads refused") != std::string::npos);
  CHECK(tap.entry("configuration")->level == ipc::HealthLevel::kWarning);
  site.push("# Whole only with the last line: # end of configuration\nmap.radius_m = 7", false);
  CHECK(comes(tap, "configuration/refused", "50-site.toml:2: the file is cut"));
  site.push("map.radius_m = 50\n", false);
  CHECK(comes(tap, "configuration", "hash " + site.hash()));
  CHECK(tap.entry("configuration/refused") == nullptr);
  CHECK(std::string(tap.health.status.configuration) == site.hash());
  check_no_gap(tap);
}

void at_the_next_start(const Site& site, Tap& tap) {
  site.push("map.cell_m = 0.3\n", true);
  CHECK(comes(tap, "configuration/next_start", "takes effect at the next start: map.cell_m"));
  std::filesystem::remove(site.drive.folder / "conf.d/50-site.toml");
  CHECK(comes(tap, "configuration", "hash " + site.hash()));
  CHECK(tap.entry("configuration/next_start") == nullptr);
}

}  // namespace

TEST_CASE("poses go on while the configuration changes, and a bad one changes nothing") {
  const Site site;
  site.push("# none\n", true);
  ChildProcess isobard({ISOBAR_DAEMON, "--config", site.drive.config});
  REQUIRE(isobard.read_until("ready:", 20s));
  std::optional<Tap> tap(std::in_place);
  ChildProcess play({ISOBAR_PROGRAM, "play", site.drive.recording});
  tap->gather(4s);
  many_reloads(isobard, site, *tap);
  refused(site, *tap);
  at_the_next_start(site, *tap);
  tap.reset();  // an attachment must not outlive isobard
  isobard.signal(SIGTERM);
  CHECK(isobard.wait(20s) == 0);
}

}  // namespace isobar::test::test_reload
