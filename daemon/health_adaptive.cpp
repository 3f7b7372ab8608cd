// SPDX-License-Identifier: BSD-3-Clause
// What the adaptive method has found: bias of the altimeter, mount of the lidar.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <string>

#include "core/geometry.hpp"
#include "core/mounts/mount_text.hpp"
#include "daemon/health.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {
namespace {

// Bias from which on its correction is said [m], and in standard deviations.
constexpr double kSaidM = 0.1;
constexpr double kSaidSigmas = 3.0;

const char* barometer_of(DriftSuspect drifts) {
  switch (drifts) {
    case DriftSuspect::kRobot:
      return "the robot's barometer";
    case DriftSuspect::kBase:
      return "the base station's barometer";
    case DriftSuspect::kNone:
    case DriftSuspect::kUnknown:
      break;
  }
  return "robot's or base station's barometer";
}

// A barometer that the prior stage says to drift - a base station whose samples it refuses, or one that drifts while the
// robot stands - although the map shows no drift any more; nullptr: none.
const char* drifting_barometer(const BarometerHealth& barometers) {
  if (barometers.robot == BarometerFault::kDrifting) return "the robot's barometer";
  if (barometers.base[0] == BarometerFault::kDrifting) return "the base station's barometer";
  if (barometers.base[1] == BarometerFault::kDrifting) return "the second base station's barometer";
  return nullptr;
}

std::string text_of(const AltimeterState& altimeter, const char* drifting) {
  const double bias_m = altimeter.bias_m;
  if (altimeter.drifts != DriftSuspect::kNone) {
    return fmt::format("{} drifts by {:.1f} mm/s, {:.2f} m off; check it; the height follows the scans",
                       barometer_of(altimeter.drifts), 1e3 * altimeter.drift_m_s, bias_m);
  }
  if (drifting != nullptr) {
    return fmt::format("{} drifts, bias {:.2f} m; check it; the height follows the scans", drifting, bias_m);
  }
  if (altimeter.faulty) {
    return fmt::format(
        "{:.2f} m off the map, more than air explains; check both barometers; the height follows the scans",
        bias_m);
  }
  const bool said = std::abs(bias_m) > kSaidM && std::abs(bias_m) > kSaidSigmas * altimeter.bias_sd_m;
  return fmt::format("bias {:.3f} m, sd {:.3f} m{}", bias_m, altimeter.bias_sd_m,
                     said ? ": a ventilated zone, weather, airflow or an old drift, corrected" : "");
}

std::string airflow_text(const AltimeterState& altimeter) {
  return fmt::format("{:+.1f} mm per (m/s)^2, sd {:.1f}: the robot's own wind at its barometer, corrected",
                     1e3 * altimeter.airflow_s2_m, 1e3 * altimeter.airflow_sd_s2_m);
}

}  // namespace

void HealthMonitor::fill_adaptive(const StatusSnapshot& now, ipc::HealthReport& report) {
  const RegistrationStatus& registration = now.registration;
  if (registration.effective_method != Method::kAdaptive) return;
  const AltimeterState& altimeter = registration.altimeter;
  // Without IMU samples the prior stage does not judge the barometers.
  const bool judged = now.now_ns - now.prior.stamp_ns <= kSensorSilenceNs;
  const char* drifting = judged ? drifting_barometer(now.prior.barometers) : nullptr;
  const bool well = !altimeter.faulty && drifting == nullptr;
  add_entry(report, "altimeter", well ? ipc::HealthLevel::kOk : ipc::HealthLevel::kWarning,
            text_of(altimeter, drifting), altimeter.bias_m);
  if (altimeter.airflow_sd_s2_m > 0.0) {
    add_entry(report, "altimeter/airflow", ipc::HealthLevel::kOk, airflow_text(altimeter),
              altimeter.airflow_s2_m);
  }
  const MountState& mount = registration.mount;
  if (!mount.found) return;
  const std::string line = mount_line(mount, config_.lidar.mount.rpy_deg);
  add_entry(report, "lidar/mount", ipc::HealthLevel::kOk, line, mount.error_rad[1] / kRadPerDeg);
  if (mount_news_.is_news(mount)) {
    spdlog::info("the lidar's mount is found and corrected; the line for the configuration: {}", line);
  }
}

}  // namespace isobar
