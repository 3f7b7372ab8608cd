// SPDX-License-Identifier: BSD-3-Clause
// The health entries of the lidar.
#include <spdlog/fmt/fmt.h>

#include "daemon/health.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/input_health.hpp"
#include "daemon/lidar_sender.hpp"
#include "daemon/timing_health.hpp"

namespace isobar {

using ipc::HealthLevel;
using ipc::HealthReport;

void HealthMonitor::fill_lidar(const StatusSnapshot& now, double elapsed_s, HealthReport& report) const {
  const auto& counters = now.lidar.counters;
  const auto& before = last_.lidar.counters;
  const double rate_hz =
      per_second(counters.scans - counters.divided, before.scans - before.divided, elapsed_s);
  const std::string where = config_.lidar.source == LidarSource::kDds
                                ? "DDS, topic " + config_.dds.topics.points
                                : "UDP port " + std::to_string(config_.lidar.port);
  if (!now.lidar_waits_for.empty()) {
    add_entry(report, "lidar", HealthLevel::kError, "waiting: " + now.lidar_waits_for, 0.0);
  } else if (rate_hz > kFastestScanHz) {
    add_entry(
        report, "lidar", HealthLevel::kError,
        fmt::format("{:.0f} scans per second on {}: no lidar turns that fast; do two send from one address?",
                    rate_hz, where),
        rate_hz);
  } else {
    add_stream(report, "lidar", now.lidar.last_packet_ns, now.now_ns, kSensorSilenceNs, rate_hz, where);
  }
  if (now.lidar.sync != LidarSync::kUnknown) {
    const bool is_faulty = now.lidar.sync == LidarSync::kFault;
    add_entry(report, "lidar/clock", is_faulty ? HealthLevel::kWarning : HealthLevel::kOk,
              std::string(kLidarSyncTexts.name(now.lidar.sync)), 0.0);
  }
  add_timing(report, "lidar", now.lidar.arrivals.figures(now.now_ns));
  add_senders(report, "lidar", now.lidar.sender, now.now_ns, "lidar.sender chooses");
  if (counters.wrong_model > before.wrong_model) {
    add_entry(report, "lidar/model", HealthLevel::kError, now.lidar.wrong_model_message.data(),
              static_cast<double>(counters.wrong_model));
  }
  add_count(report, "lidar/packets_lost", counters.lost, before.lost,
            "packets lost, by the gaps in the sensor's time");
  add_count(report, "lidar/garbage", counters.garbage + counters.truncated + counters.oversized,
            before.garbage + before.truncated + before.oversized, "packets of another format, refused");
  add_count(report, "lidar/reordered", counters.reordered + counters.duplicated,
            before.reordered + before.duplicated, "packets duplicated or out of order");
  add_count(report, "lidar/dropped_by_kernel", now.lidar.dropped_by_kernel, last_.lidar.dropped_by_kernel,
            "datagrams dropped by the kernel: the machine is overloaded");
  if (!now.lidar_info_waits_for.empty()) {
    // Position and device information are of use, but not needed; the samples of an IMU are.
    const bool is_needed = config_.imu.source == ImuSource::kLidar;
    add_entry(report, "lidar/info_port", is_needed ? HealthLevel::kError : HealthLevel::kWarning,
              "waiting: " + now.lidar_info_waits_for, 0.0);
  }
  add_count(report, "lidar/info_refused", now.lidar.info_refused, last_.lidar.info_refused,
            "packets on the lidar's second port that are data or another machine's, refused");
  add_count(report, "lidar/no_memory", now.lidar.scans_without_memory, last_.lidar.scans_without_memory,
            "scans dropped: no free chunk of shared memory");
}

}  // namespace isobar
