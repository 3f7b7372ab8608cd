// SPDX-License-Identifier: BSD-3-Clause
// What the adaptive method has found: bias of the altimeter, mount of the lidar.
#include <spdlog/fmt/fmt.h>

#include "core/geometry.hpp"
#include "daemon/health.hpp"
#include "daemon/health_entries.hpp"

namespace isobar {

void HealthMonitor::fill_adaptive(const RegistrationStatus& registration, ipc::HealthReport& report) {
  if (registration.effective_method != Method::kAdaptive) return;
  const double bias_m = registration.altimeter.bias_m;
  add_entry(
      report, "altimeter", registration.altimeter.faulty ? ipc::HealthLevel::kWarning : ipc::HealthLevel::kOk,
      registration.altimeter.faulty
          ? fmt::format(
                "differs from the map by {:.2f} m, more than air explains: a barometer, of the robot or of "
                "the base station, drifts or is wrong; the height follows the scans",
                bias_m)
          : fmt::format("bias {:.3f} m, sd {:.3f} m", bias_m, registration.altimeter.bias_sd_m),
      bias_m);
  if (!registration.mount.found) return;
  const auto& error = registration.mount.error_rad;
  const auto& sigma = registration.mount.sigma_rad;
  add_entry(report, "lidar/mount", ipc::HealthLevel::kOk,
            fmt::format(
                "turned by {:.2f}, {:.2f}, {:.2f} deg (roll, pitch, yaw; sd {:.2f}, {:.2f}, {:.2f}) against "
                "lidar.rpy_deg, and corrected; `isobar calibrate mounts` gives the line for the file",
                error[0] / kRadPerDeg, error[1] / kRadPerDeg, error[2] / kRadPerDeg, sigma[0] / kRadPerDeg,
                sigma[1] / kRadPerDeg, sigma[2] / kRadPerDeg),
            error[1] / kRadPerDeg);
}

}  // namespace isobar
