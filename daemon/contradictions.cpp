// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/contradictions.hpp"

#include <array>
#include <string>

#include "core/contradictions/finding_text.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {

namespace {

/// Names of the sensors' main entries, by CheckedSensor.
constexpr std::array<const char*, kCheckedSensors> kEntryNames{"lidar", "imu", "barometer", "base_station",
                                                               "wheels"};

}  // namespace

Config without_unusable(Config config, const UsableSensors& usable) {
  if (!usable.imu) config.imu.source = ImuSource::kNone;
  return config;
}

void add_contradictions(ipc::HealthReport& report, const Findings& findings) {
  std::array<bool, kCheckedSensors> named{};
  for (const Finding& finding : findings.all()) {
    const auto sensor = static_cast<std::size_t>(finding.sensor);
    // One entry a sensor; its further findings stand in the run's counters.
    if (named[sensor]) continue;
    named[sensor] = true;
    add_entry(report, std::string(kEntryNames[sensor]) + "/contradiction", ipc::HealthLevel::kError,
              finding_text(finding), finding.measured);
  }
  const std::string left_out = left_out_text(usable_sensors(findings));
  if (!left_out.empty()) add_entry(report, "input/left_out", ipc::HealthLevel::kWarning, left_out, 0.0);
}

void add_contradictions(std::vector<files::RunCount>& counts, const Findings& findings) {
  for (const Finding& finding : findings.all()) counts.push_back({"contradiction", 1, finding_text(finding)});
}

}  // namespace isobar
