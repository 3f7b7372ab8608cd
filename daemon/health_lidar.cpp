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
namespace {

using ipc::HealthLevel;

/// State of the lidar's clock, and whether it stamps the points where it is to.
void add_lidar_clock(ipc::HealthReport& report, LidarTime wanted, const LidarStatus& lidar) {
  const std::string state(kLidarSyncTexts.name(lidar.sync));
  if (wanted == LidarTime::kSensor && lidar.counters.scans > 0) {
    const std::string reason =
        may_stamp(lidar.sync) ? "its seconds are not those of this machine's clock" : state;
    add_entry(
        report, "lidar/clock", lidar.sensor_stamps ? HealthLevel::kOk : HealthLevel::kWarning,
        lidar.sensor_stamps ? "stamps the points; " + state : "receive times stamp the points: " + reason,
        0.0);
  } else if (lidar.sync != LidarSync::kUnknown) {
    const bool is_faulty = lidar.sync == LidarSync::kFault;
    add_entry(report, "lidar/clock", is_faulty ? HealthLevel::kWarning : HealthLevel::kOk, state, 0.0);
  }
}

}  // namespace

using ipc::HealthLevel;
using ipc::HealthReport;

void HealthMonitor::fill_lidar(const StatusSnapshot& now, double elapsed_s, HealthReport& report) const {
  const auto& counters = now.lidar.counters;
  const auto& before = last_.lidar.counters;
  const auto scans = static_cast<double>(counters.scans - counters.divided - (before.scans - before.divided));
  const double rate_hz = elapsed_s > 0.0 ? scans / elapsed_s : 0.0;
  // A report may follow the last one at once, with a scan in between.
  constexpr double kMostInAShortTime = 2.0;
  const std::string where = config_.lidar.source == LidarSource::kDds
                                ? "DDS, topic " + config_.dds.topics.points
                                : "UDP port " + std::to_string(config_.lidar.port);
  if (!now.lidar_waits_for.empty()) {
    add_entry(report, "lidar", HealthLevel::kError, "waiting: " + now.lidar_waits_for, 0.0);
  } else if (scans > kFastestScanHz * elapsed_s + kMostInAShortTime) {
    add_entry(
        report, "lidar", HealthLevel::kError,
        fmt::format("{:.0f} scans per second on {}: no lidar turns that fast; do two send from one address?",
                    rate_hz, where),
        rate_hz);
  } else {
    add_stream(report, "lidar", now.lidar.last_packet_ns, now.now_ns, silence_limit_ns(now.lidar), rate_hz,
               where);
  }
  add_lidar_clock(report, config_.lidar.time, now.lidar);
  add_timing(report, "lidar", now.lidar.arrivals.figures(now.now_ns));
  add_senders(report, "lidar", now.lidar.sender, now.now_ns, "lidar.sender chooses");
  if (counters.wrong_model > before.wrong_model) {
    add_entry(report, "lidar/model", HealthLevel::kError, now.lidar.wrong_model_message.data(),
              static_cast<double>(counters.wrong_model));
  }
  if (now.lidar.contradiction != nullptr) {
    add_entry(report, "lidar/mode", HealthLevel::kWarning, now.lidar.contradiction, 0.0);
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
