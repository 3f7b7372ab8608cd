// SPDX-License-Identifier: BSD-3-Clause
// All that Isobar says over DDS, one function a topic.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/estimates.hpp"
#include "core/registration/pose_propagator.hpp"
#include "ipc/dds/dds_config.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/messages.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

/// Lets every n-th sample through, so that at most `rate_hz` come out.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

  /// True when a message with this stamp is due. A stamp that went back starts over.
  bool due(std::int64_t stamp_ns) noexcept {
    // A tenth of the period early, so that a source of just this rate with jitter is not halved.
    if (stamp_ns >= last_ns_ && stamp_ns - last_ns_ < period_ns_ - period_ns_ / 10) {
      return false;
    }
    last_ns_ = stamp_ns;
    return true;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t last_ns_ = INT64_MIN / 2;
};

/// odom, pose, tf, tf_static, altitude, diagnostics. One thread.
class PoseOutputs {
 public:
  /// @throws ServiceError DDS refuses
  PoseOutputs(dds_entity_t participant, const DdsConfig& config, const SensorMounts& mounts);
  PoseOutputs(const PoseOutputs&) = delete;
  PoseOutputs& operator=(const PoseOutputs&) = delete;

  /// Publishes altitude, odom and tf at their rates.
  void on_prior(const Prior& prior);
  void on_pose(const PoseEstimate& pose);
  /// Publishes what the builder holds.
  void write_diagnostics(const DiagnosticsBuilder& builder) { diagnostics_.write(builder.message()); }

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  void write_static_transforms(const SensorMounts& mounts);
  void write_transforms(const Odometry& odometry);

  DdsConfig config_;
  PosePropagator propagator_;
  RateLimit odom_rate_;
  RateLimit altitude_rate_;
  Writer<OdometryMessage> odom_;
  Writer<PoseMessage> pose_;
  Writer<TfMessage> tf_;
  Writer<TfMessage> tf_static_;
  Writer<AltitudeMessage> altitude_;
  Writer<DiagnosticsMessage> diagnostics_;
};

/// registered_scan and map. One thread, which need not be that of PoseOutputs.
class CloudOutputs {
 public:
  /// @throws ServiceError DDS refuses
  CloudOutputs(dds_entity_t participant, const DdsConfig& config);
  CloudOutputs(const CloudOutputs&) = delete;
  CloudOutputs& operator=(const CloudOutputs&) = delete;

  /// The scan in the frame of base_link at its stamp, the end of the scan. Nothing is sent if nobody listens.
  void on_scan(const RegisteredScan& scan);
  /// The local map in the map frame.
  void on_map(const ipc::MapCloud& map);

  [[nodiscard]] std::vector<dds_entity_t> writers() const { return {scan_.get(), map_.get()}; }
  [[nodiscard]] std::uint64_t failures() const noexcept { return scan_.failures() + map_.failures(); }

 private:
  DdsConfig config_;
  CloudBuilder builder_;
  Writer<CloudMessage> scan_;
  Writer<CloudMessage> map_;
};

}  // namespace isobar::dds
