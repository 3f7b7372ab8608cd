// SPDX-License-Identifier: BSD-3-Clause
// The part of HealthMonitor that tells what the prior knows: attitude and height, or why it knows none.
#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "core/names.hpp"
#include "core/stamp.hpp"
#include "daemon/health.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {

using ipc::HealthLevel;
using ipc::HealthReport;

namespace {

void add_attitude(HealthReport& report, bool has_imu, bool valid) {
  const char* text = !has_imu ? "no IMU: level at the start; roll and pitch drift with the way"
                     : valid  ? "gravity found"
                              : "waiting for gravity from the IMU";
  add_entry(report, "attitude", valid || !has_imu ? HealthLevel::kOk : HealthLevel::kStale, text, 0.0);
}

}  // namespace

void HealthMonitor::fill_prior(const StatusSnapshot& now, HealthReport& report) const {
  const PriorStatus& prior = now.prior;
  const PriorCounters& used = prior.counters;
  const PriorCounters& before = last_.prior.counters;
  add_calibration(report, "barometer", used.pressure_outside_calibration, before.pressure_outside_calibration,
                  used.pressure_without_temperature, before.pressure_without_temperature);
  add_calibration(report, "base_station", used.base_outside_calibration, before.base_outside_calibration,
                  used.base_without_temperature, before.base_without_temperature);
  // Without IMU samples there are no priors: what the last one said is no longer known.
  if (prior.stamp_ns == 0 || now.now_ns - prior.stamp_ns > kSensorSilenceNs) {
    const std::string text =
        prior.stamp_ns == 0 ? "waiting for the IMU" : silence_text("IMU sample", prior.stamp_ns, now.now_ns);
    add_entry(report, "attitude", HealthLevel::kStale, text, 0.0);
    add_entry(report, "height", HealthLevel::kStale, text, prior.height_m);
    return;
  }
  add_attitude(report, config_.imu.present(), prior.attitude_valid);
  if (!config_.barometer.present()) {
    add_entry(report, "height", HealthLevel::kOk, "no barometer: the lidar's, drifts with the way", 0.0);
    return;
  }
  const bool without_base = !config_.input.expect_base_station && !prior.base_stations[0].started() &&
                            prior.height_source == HeightSource::kSingleBarometer;
  const bool height_good = prior.height_source == HeightSource::kDifferential || without_base;
  add_entry(report, "height", height_good ? HealthLevel::kOk : HealthLevel::kWarning,
            fmt::format("source: {}, sd {:.3f} m{}", kHeightSourceNames.name(prior.height_source),
                        std::sqrt(prior.height_variance_m2), without_base ? ", drifts with the weather" : ""),
            prior.height_m);
}

}  // namespace isobar
