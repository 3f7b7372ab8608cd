// SPDX-License-Identifier: BSD-3-Clause
// Faults and deviations that a user asks for, in the recordings.
#include "simulation/deviations.hpp"

#include <doctest/doctest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>
#include <regex>
#include <set>

#include <sstream>

#include "core/errors.hpp"
#include "run/recording/manifest.hpp"
#include "simulation/simulate.hpp"

namespace isobar::test::test_deviations {

using namespace isobar::simulation;
namespace fs = std::filesystem;

namespace {

/// Recordings of one scenario, deleted at the end of the test.
class Recordings {
 public:
  Recordings() {
    std::string pattern = (fs::temp_directory_path() / "isobar-deviations-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Recordings() { fs::remove_all(folder_); }
  Recordings(const Recordings&) = delete;
  Recordings& operator=(const Recordings&) = delete;

  fs::path make(const Deviations& deviations, double stop_after_s = 2.0, const char* name = "stairs-demo") {
    ScenarioRequest request;
    request.name = name;
    request.seed = 3;
    request.short_form = true;
    request.stop_after_s = stop_after_s;
    request.deviations = deviations;
    const fs::path folder = folder_ / std::to_string(count_++);
    simulate(request, folder, {});
    return folder;
  }

 private:
  fs::path folder_;
  int count_ = 0;
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct Row {
  double time_s;  ///< since the first row
  double pressure_pa;
  double temperature_c;
};

std::vector<Row> rows(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<Row> rows;
  long long first = 0;
  while (std::getline(stream, line)) {
    long long stamp = 0;
    Row row{};
    REQUIRE(std::sscanf(line.c_str(), "%lld,%lf,%lf", &stamp, &row.pressure_pa, &row.temperature_c) == 3);
    if (rows.empty()) first = stamp;
    row.time_s = 1e-9 * static_cast<double>(stamp - first);
    rows.push_back(row);
  }
  return rows;
}

recording::Manifest manifest_of(const fs::path& folder) {
  std::vector<std::string> warnings;
  recording::Manifest manifest = recording::read_manifest(folder, warnings);
  CHECK(warnings.empty());
  return manifest;
}

/// True mount of a sensor as the description has it: roll, pitch, yaw [deg].
Eigen::Vector3d true_rpy_deg(const std::string& description, const std::string& sensor) {
  const std::regex pattern(sensor + R"( rpy_deg \[([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\])");
  std::smatch match;
  REQUIRE(std::regex_search(description, match, pattern));
  return {std::stod(match[1]), std::stod(match[2]), std::stod(match[3])};
}

}  // namespace

TEST_CASE("a deviation changes its own files only: the other files are those of the same seed") {
  struct Case {
    const char* changed;
    std::function<void(Deviations&)> set;
  };
  const std::vector<Case> cases{
      {"barometer.csv", [](Deviations& d) { d.robot.drift.rate_pa_s = 0.5; }},
      {"base_barometer.csv", [](Deviations& d) { d.base.drift.rate_pa_s = -0.5; }},
      {"barometer.csv", [](Deviations& d) { d.robot.thermometer_offset_k = -60.0; }},
      {"base_barometer.csv", [](Deviations& d) { d.base_rate_hz = 4.0; }},
      {"base_barometer.csv",
       [](Deviations& d) {
         d.base_silent = TimeSpan{0.5, 1.0};
       }},
      {"barometer.csv base_barometer.csv", [](Deviations& d) { d.common_ramp.rate_pa_s = 1.0; }},
      {"barometer.csv base_barometer.csv",
       [](Deviations& d) {
         d.common_gust = {3.0, 0.2};
       }},
      {"lidar.pcap imu.csv", [](Deviations& d) { d.mount_error_deg = 0.5; }},
      {"barometer.csv",
       [](Deviations& d) {
         d.zones = PressureRange{1.0, 4.0};
       }},
      {"imu.csv", [](Deviations& d) { d.without_imu = true; }},
      {"wheel.csv", [](Deviations& d) { d.without_wheels = true; }},
      {"base_barometer.csv", [](Deviations& d) { d.without_base = true; }},
      {"barometer.csv", [](Deviations& d) { d.without_barometer = true; }},
  };
  Recordings recordings;
  const fs::path plain = recordings.make({});
  for (const Case& test : cases) {
    Deviations deviations;
    test.set(deviations);
    REQUIRE(deviations.options().size() == 1);
    CAPTURE(deviations.options().front());
    const fs::path folder = recordings.make(deviations);
    for (const auto& entry : fs::directory_iterator(plain)) {
      const std::string name = entry.path().filename().string();
      CAPTURE(name);
      const bool wanted = name == "recording.toml" || std::string(test.changed).find(name) == 0 ||
                          std::string(test.changed).find(" " + name) != std::string::npos;
      CHECK((content(entry.path()) != content(folder / name)) == wanted);
    }
    CHECK(manifest_of(folder).description.find("; --" + deviations.options().front() + ";") !=
          std::string::npos);
  }
}

TEST_CASE("a drifting barometer is off by rate times time within its span and keeps its offset afterwards") {
  Recordings recordings;
  Deviations deviations;
  deviations.base.drift = {2.0, 0.5, 1.0};
  const std::vector<Row> plain = rows(recordings.make({}) / "base_barometer.csv");
  const std::vector<Row> drifting = rows(recordings.make(deviations) / "base_barometer.csv");
  REQUIRE(plain.size() == drifting.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    // The first base sample is taken up to 1/32 s after 0.01 s: 2 Pa/s make 8 cPa of that.
    const double wanted = 2.0 * std::clamp(plain[i].time_s + 0.02 - 0.5, 0.0, 1.0);
    CHECK(std::abs(drifting[i].pressure_pa - plain[i].pressure_pa - wanted) < 0.08);
  }
}

TEST_CASE("ramp and gust of the air are the same at both barometers") {
  Recordings recordings;
  Deviations deviations;
  deviations.common_ramp.rate_pa_s = 1.0;
  deviations.common_gust = {3.0, 0.5};
  const fs::path plain = recordings.make({});
  const fs::path folder = recordings.make(deviations);
  for (const char* name : {"barometer.csv", "base_barometer.csv"}) {
    const std::vector<Row> before = rows(plain / name);
    const std::vector<Row> after = rows(folder / name);
    REQUIRE(before.size() == after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const double t = before[i].time_s;
      if (t < 0.15) continue;  // before the first knot of the air's time grid, where it is constant
      const double wanted = t + 3.0 * std::sin(std::numbers::pi * t);
      // Samples lag and lead by up to 0.04 s, at slopes of up to 10.4 Pa/s.
      CHECK(std::abs(after[i].pressure_pa - before[i].pressure_pa - wanted) < 0.45);
    }
  }
}

TEST_CASE("a base station at a lower rate sends every n-th of its samples, and none while it is silent") {
  Recordings recordings;
  Deviations deviations;
  deviations.base_rate_hz = 4.0;
  const std::vector<Row> slow = rows(recordings.make(deviations, 3.0) / "base_barometer.csv");
  CHECK(slow.size() == 12);
  for (std::size_t i = 1; i < slow.size(); ++i) {
    CHECK(std::abs(slow[i].time_s - slow[i - 1].time_s - 0.25) < 0.003);  // jitter of stamps: below 2 ms
  }
  deviations = {};
  deviations.base_silent = TimeSpan{1.0, 2.5};
  double gap_s = 0.0;
  const std::vector<Row> silent = rows(recordings.make(deviations, 3.0) / "base_barometer.csv");
  for (std::size_t i = 1; i < silent.size(); ++i)
    gap_s = std::max(gap_s, silent[i].time_s - silent[i - 1].time_s);
  CHECK(gap_s > 1.45);
  CHECK(gap_s < 1.58);
}

TEST_CASE("mounting errors have the size asked for; the manifest keeps what the robot believes") {
  Deviations deviations;
  deviations.mount_error_deg = 2.0;
  double sum = 0.0;
  int count = 0;
  const fs::path scratch = fs::temp_directory_path() / ("isobar-mounts-" + std::to_string(getpid()));
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ScenarioRequest request{"stairs-demo", seed, true, 0.01, deviations};
    fs::remove_all(scratch);
    simulate(request, scratch, {});
    const recording::Manifest manifest = manifest_of(scratch);
    CHECK(manifest.lidar->mount.rpy_deg.norm() < 1e-12);
    CHECK(manifest.imu->mount.rpy_deg.norm() < 1e-12);
    for (const char* sensor : {"lidar", "imu"}) {
      sum += true_rpy_deg(manifest.description, sensor).squaredNorm();
      count += 3;
    }
  }
  fs::remove_all(scratch);
  // Variance of 120 draws: relative sd sqrt(2 / 120) = 13 %; four of them.
  CHECK(sum / count > 4.0 * 0.48);
  CHECK(sum / count < 4.0 * 1.52);
}

TEST_CASE("a recording that starts later is the rest of the whole one, row by row and packet by packet") {
  Recordings recordings;
  Deviations deviations;
  deviations.start_at_s = 1.0;
  const fs::path whole = recordings.make({});
  const fs::path rest = recordings.make(deviations);
  for (const char* name : {"imu.csv", "wheel.csv", "barometer.csv", "base_barometer.csv", "reference.tum"}) {
    CAPTURE(name);
    const std::string later = content(rest / name);
    const std::string all = content(whole / name);
    const std::string body = later.substr(later.find('\n') + 1);
    CHECK(later.size() > all.size() / 3);
    CHECK(later.size() < 2 * all.size() / 3);
    CHECK(all.ends_with(body));
  }
  // A record of the pcap file: 16 bytes, Ethernet, IPv4 and UDP headers of 42, a packet of 1206.
  constexpr std::size_t kRecordBytes = 16 + 42 + 1206;
  constexpr std::size_t kPacketBytes = 1206;
  const std::string packets = content(rest / "lidar.pcap");
  const std::string all = content(whole / "lidar.pcap");
  CHECK(packets.size() > all.size() / 3);
  CHECK(packets.size() < 2 * all.size() / 3);
  for (std::size_t last = kPacketBytes; last < packets.size(); last += kRecordBytes) {
    CHECK(
        (packets.substr(packets.size() - last, kPacketBytes) == all.substr(all.size() - last, kPacketBytes)));
  }
  deviations.start_at_s = 100'000.0;
  CHECK_THROWS_AS(recordings.make(deviations), UsageError);
}

TEST_CASE("a place without ventilated zones refuses to give them offsets") {
  Recordings recordings;
  Deviations deviations;
  deviations.zones = PressureRange{3.0, 4.0};
  CHECK_THROWS_AS(recordings.make(deviations, 0.1, "moulin"), UsageError);
}

TEST_CASE("names of recordings differ by scenario, seed, form and every deviation") {
  std::set<std::string> names;
  std::vector<Deviations> all(15);
  all[1].mount_error_deg = 0.5;
  all[2].robot.drift = {0.5, 60.0, 70.0};
  all[3].base.drift = {0.5, 60.0, 70.0};
  all[4].robot.drift = {0.5, 0.0, INFINITY};
  all[5].base.thermometer_offset_k = 20.0;
  all[6].base_rate_hz = 4.0;
  all[7].common_ramp.rate_pa_s = 0.5;
  all[8].common_gust = {3.0, 0.2};
  all[9].base_silent = TimeSpan{60.0, 180.0};
  all[10].without_wheels = true;
  all[11].airflow = -0.3;
  all[12].zones = PressureRange{1.0, 4.0};
  all[13].pulses = PressureRange{1.0, 4.0};
  all[14].start_at_s = 20.0;
  for (const Deviations& deviations : all) {
    const std::string name = recording_name({"hill", 2, true, INFINITY, deviations});
    CHECK(name.find_first_of(" :/") == std::string::npos);
    names.insert(name);
  }
  CHECK(names.size() == all.size());
  CHECK(names.contains("hill-2-short"));
  CHECK(names.contains("hill-2-short-drift-robot-0.5-60-70"));
  CHECK(names.contains("hill-2-short-base-silent-60-120"));
}

}  // namespace isobar::test::test_deviations
