// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/estimates.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/registration/registration.hpp"
#include "daemon/scan_queue.hpp"
#include "daemon/silence_bridge.hpp"

namespace isobar {

/// Receives the poses of a RegistrationStage.
class EstimateSink {
 public:
  virtual ~EstimateSink() = default;
  /// @param pose stamps strictly ascending
  /// @param prior the newest prior when the pose was made
  virtual void on_pose(const PoseEstimate& pose, const Prior& prior) = 0;
};

/// Registration as a stage: every scan of a ScanQueue gets one pose at its end, from the map or from the
/// prior, and a silent lidar gets poses from the prior. A scan that ends before a pose of silence yields its pose
/// at the newest prior. Live runs (RegistrationThread) and replay (LockStep)
/// run this same object. Allocates nothing after construction beyond what Registration does. One thread.
class RegistrationStage {
 public:
  /// @param sink receives the poses; outlives the stage
  RegistrationStage(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar,
                    EstimateSink& sink);

  /// Exchanges `next` for the registration in use, which goes on in it. Allocates nothing.
  void replace(std::unique_ptr<Registration>& next) {
    next->take_over(*registration_);
    registration_.swap(next);
  }

  /// See Registration.
  void begin_at(std::uint32_t session, const std::optional<KnownPlace>& place);
  void begin_new_frame();
  void wait_for_place(bool waits) { registration_->wait_for_place(waits); }
  void give_up_place() { registration_->give_up_place(); }
  void stay_in(const KnownPlace& place) { registration_->stay_in(place); }
  void hint(const PlaceHint& hint) { registration_->hint(hint); }
  /// A place found by the search of the whole map: the hint of a person goes first.
  void offer_place(const PlaceHint& place) {
    if (!registration_->has_hint()) registration_->hint(place);
  }
  [[nodiscard]] const HintReport& hint_report() const { return registration_->hint_report(); }
  [[nodiscard]] std::uint32_t session() const { return registration_->session(); }
  [[nodiscard]] bool searching() const { return registration_->searching(); }

  /// Takes a prior; in order of time.
  void add_prior(const Prior& prior);
  /// Stamp of the newest prior; 0: none yet.
  [[nodiscard]] std::int64_t newest_prior_ns() const noexcept { return newest_prior_.stamp_ns; }

  /// Registers the scan against the map and emits its pose, with the CPU time of the registration.
  /// @param out pose and deskewed, thinned points, for the map
  void register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out);
  /// Emits the prior's pose at the end of a scan that was dropped.
  /// @param scratch overwritten
  void skip_scan(const DroppedScan& scan, const MapSnapshot& map, RegisteredScan& scratch);
  /// Emits a pose at the newest prior when the lidar is silent.
  /// @return true when a pose was made
  bool bridge_silence();

 private:
  void emit(const PoseEstimate& pose, bool from_scan);
  void emit_late(const PoseEstimate& of_scan);

  std::unique_ptr<Registration> registration_;
  EstimateSink& sink_;
  std::unique_ptr<Scan> without_points_;  ///< stands in for a dropped scan
  Prior newest_prior_;
  SilenceBridge silence_;
};

}  // namespace isobar
