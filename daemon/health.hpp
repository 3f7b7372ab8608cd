// SPDX-License-Identifier: BSD-3-Clause
// Health report of a robot: state of each sensor, punctuality of each stage, counts of refused data.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "config/config.hpp"
#include "core/contradictions/finding.hpp"
#include "daemon/device_thread.hpp"
#include "daemon/lidar_thread.hpp"
#include "daemon/map_thread.hpp"
#include "daemon/mount_news.hpp"
#include "daemon/output_status.hpp"
#include "daemon/place_status.hpp"
#include "daemon/prior_thread.hpp"
#include "daemon/registration_thread.hpp"
#include "daemon/sample_thread.hpp"
#include "daemon/start_over.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// Status of all threads at one moment.
struct StatusSnapshot {
  std::int64_t now_ns = 0;  ///< robot clock
  LidarStatus lidar;
  SampleThreadStatus samples;
  DeviceThreadStatus imu;
  DeviceThreadStatus barometer;
  DeviceThreadStatus wheels;
  PriorStatus prior;
  RegistrationStatus registration;
  MapStatus map;
  OutputStatus output;
  std::string lidar_waits_for{};  ///< see UdpReceiver::waiting_for()
  std::string lidar_info_waits_for{};
  std::string samples_wait_for{};
  Findings contradictions{};
  PlaceStatus place{};
  std::string other_station{};  ///< see RunStart
};

class StageTimes;

/// Adds the health entries and figures of a robot's stages to a report. Rates and growth of counters refer to the time
/// since the last call. One thread.
class HealthMonitor {
 public:
  explicit HealthMonitor(const Config& config);
  ~HealthMonitor();
  HealthMonitor(const HealthMonitor&) = delete;
  HealthMonitor& operator=(const HealthMonitor&) = delete;

  /// Takes a changed configuration.
  void configure(const Config& config) { config_ = config; }

  void fill(const StatusSnapshot& now, ipc::HealthReport& report);
  /// True once for each time that the input starts over, see StartOver; fill() reports them.
  [[nodiscard]] bool input_starts_over(const LidarStatus& lidar, const SampleInputStatus& samples,
                                       const PriorStatus& prior) noexcept {
    // Of DDS samples the sender's clock is not known here; there a silence says that the stream began anew.
    const bool by_datagram = samples.counters.samples[static_cast<std::size_t>(datagram::Kind::kImu)] > 0;
    return start_over_.check(
        {lidar.clock_jumped_ns, by_datagram ? samples.imu_began_ns : prior.imu_resumed_ns});
  }

 private:
  void fill_lidar(const StatusSnapshot& now, double elapsed_s, ipc::HealthReport& report) const;
  void fill_samples(const StatusSnapshot& now, double elapsed_s, ipc::HealthReport& report) const;
  void fill_base_stations(const StatusSnapshot& now, ipc::HealthReport& report) const;
  static void fill_faults(const StatusSnapshot& now, ipc::HealthReport& report);
  void fill_prior(const StatusSnapshot& now, ipc::HealthReport& report) const;
  void fill_adaptive(const StatusSnapshot& now, ipc::HealthReport& report);
  void fill_registration(const StatusSnapshot& now, ipc::HealthReport& report);
  void fill_map(const StatusSnapshot& now, ipc::HealthReport& report) const;
  void fill_deadlines(const StatusSnapshot& now, ipc::HealthReport& report) const;

  Config config_;
  StartOver start_over_;
  MountNews mount_news_;
  StatusSnapshot last_;
  std::unique_ptr<StageTimes> times_;
};

}  // namespace isobar
