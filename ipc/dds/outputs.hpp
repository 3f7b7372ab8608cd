// SPDX-License-Identifier: BSD-3-Clause
// DDS outputs: the published topics and their rates. An output outlives its DDS writers, which are made anew
// when the network changes: what it has gathered from earlier messages is kept. Without writers it takes
// messages and publishes none.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/estimates.hpp"
#include "core/registration/pose_propagator.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/messages.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

/// Thins a stream of samples to `rate_hz` on average; a slower stream passes unchanged.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

  /// True when a message with this stamp is due. A stamp more than two periods before the next due time
  /// restarts the schedule.
  bool due(std::int64_t stamp_ns) noexcept {
    // Tolerance of a tenth of the period, so that jitter of a source at exactly this rate drops no sample.
    // The schedule advances by whole periods, so the average rate stays exact.
    const std::int64_t early_ns = next_ns_ - stamp_ns;
    if (early_ns > period_ns_ / 10 && early_ns <= 2 * period_ns_) {
      return false;
    }
    const bool on_time = early_ns <= period_ns_ / 10 && early_ns > -period_ns_;
    next_ns_ = (on_time ? next_ns_ : stamp_ns) + period_ns_;
    return true;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_ = INT64_MIN / 2;
};

/// odom, pose, tf, tf_static, altitude. One thread at a time.
class PoseOutputs {
 public:
  PoseOutputs(const DdsConfig& config, const SensorMounts& mounts);
  PoseOutputs(const PoseOutputs&) = delete;
  PoseOutputs& operator=(const PoseOutputs&) = delete;

  /// Takes other settings while closed.
  void configure(const DdsConfig& config, const SensorMounts& mounts);
  /// Makes the writers and publishes tf_static.
  /// @throws ServiceError when a DDS entity cannot be created
  void open(dds_entity_t participant);
  void close() noexcept;

  /// Time of day minus robot clock, added to the stamps of all later messages [ns]. The values of on_prior() and
  /// on_pose() stay on the robot clock, which never jumps.
  void set_stamp_shift_ns(std::int64_t shift_ns) noexcept { shift_ns_ = shift_ns; }
  /// Publishes odom and tf, and altitude while it has a source, at their rates. Nothing before the first pose.
  void on_prior(const Prior& prior);
  /// Publishes the pose and passes it to the propagator of odom and tf. Ignores poses of the bootstrap: until
  /// the first registration there is no pose.
  void on_pose(const PoseEstimate& pose);

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  /// Messages that were not sent since open().
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  struct Writers {
    Writers(dds_entity_t participant, const DdsConfig& config);
    Writer<OdometryMessage> odom;
    Writer<PoseMessage> pose;
    Writer<AltitudeMessage> altitude;
    std::optional<Writer<TfMessage>> tf;         ///< null: neither transform is published
    std::optional<Writer<TfMessage>> tf_static;  ///< null: not published
  };

  void follow_session(std::uint32_t session);
  void write_static_transforms();
  void write_transforms(const Odometry& odometry);

  DdsConfig config_;  ///< map_frame is that of session_
  std::string first_map_frame_;
  std::uint32_t session_ = 1;
  SensorMounts mounts_;
  std::int64_t shift_ns_ = 0;
  PosePropagator propagator_;
  PoseEstimate last_pose_;
  RateLimit odom_rate_;
  RateLimit altitude_rate_;
  std::optional<Writers> to_;
};

/// Outputs of a base station: NAME/fluid_pressure and NAME/temperature, with equal stamps. One thread at a
/// time.
class StationOutputs {
 public:
  /// base_station of the configuration is the name of the base station and of its frame.
  explicit StationOutputs(const DdsConfig& config);
  StationOutputs(const StationOutputs&) = delete;
  StationOutputs& operator=(const StationOutputs&) = delete;

  /// Takes other settings while closed.
  void configure(const DdsConfig& config) { config_ = config; }
  /// @throws ServiceError when a DDS entity cannot be created
  void open(dds_entity_t participant);
  void close() noexcept { to_.reset(); }

  /// A sample whose temperature is NaN gives a pressure message only.
  /// @param shift_ns see PoseOutputs::set_stamp_shift_ns()
  void on_pressure(const PressureSample& measured, std::int64_t shift_ns);

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  struct Writers {
    Writer<PressureMessage> pressure;
    Writer<TemperatureMessage> temperature;
  };
  DdsConfig config_;
  std::optional<Writers> to_;
};

/// registered_scan and map_cloud. One thread at a time; it may differ from the thread of PoseOutputs.
class CloudOutputs {
 public:
  explicit CloudOutputs(const DdsConfig& config);
  CloudOutputs(const CloudOutputs&) = delete;
  CloudOutputs& operator=(const CloudOutputs&) = delete;

  /// Takes other settings while closed.
  void configure(const DdsConfig& config) { config_ = config; }
  /// Makes the writers; publishes the last complete map.
  /// @throws ServiceError when a DDS entity cannot be created
  void open(dds_entity_t participant);
  void close() noexcept { to_.reset(); }

  /// Publishes the deskewed scan in base_link at the scan's end, which is its stamp. Skipped without readers.
  /// @param shift_ns see PoseOutputs::set_stamp_shift_ns()
  void on_scan(const RegisteredScan& scan, std::int64_t shift_ns);
  /// Takes a piece of the local map; publishes the map, in the map frame, with its last piece.
  void on_map(const ipc::MapCloud& piece, std::int64_t shift_ns);

  [[nodiscard]] bool map_has_readers() const noexcept { return to_ && to_->map.has_readers(); }
  /// Frees the memory of the map; the next on_map() begins a new one.
  void forget_map();

  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;

 private:
  struct Writers {
    Writer<CloudMessage> scan;
    Writer<CloudMessage> map;
  };
  void write_map();

  DdsConfig config_;
  CloudBuilder scan_builder_{CloudBuilder::Fields::kWithRing};
  CloudBuilder map_builder_{CloudBuilder::Fields::kWithoutRing};
  MapAssembly map_;
  std::uint32_t map_session_ = 1;  ///< of the newest map
  std::int64_t map_shift_ns_ = 0;
  std::optional<Writers> to_;
};

}  // namespace isobar::dds
