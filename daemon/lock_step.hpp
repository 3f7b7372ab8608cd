// SPDX-License-Identifier: BSD-3-Clause
// The pipeline in lock step: every sample passes all stages before the next one is looked at. No scan is
// dropped, and the same input gives the same output to the last bit. The live daemon runs the same stages,
// one thread each.
//
//   packets ─▶ decoder ─▶ scan ──────────────┐
//   samples ─▶ prior estimator ─▶ prior ─────┴▶ registration ─▶ pose, registered scan ─▶ map ─▶ snapshot
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "core/estimates.hpp"
#include "core/map/local_map.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/registration/registration.hpp"
#include "daemon/silence.hpp"
#include "drivers/velodyne/velodyne_decoder.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {

/// Everything that the stages need to know.
struct StageSettings {
  velodyne::VelodyneConfig lidar;
  PriorConfig prior;
  RegistrationConfig registration;
  MapConfig map;
  Method method = Method::k3Dof;
  Eigen::Isometry3d T_base_lidar = Eigen::Isometry3d::Identity();
};

/// Receives what the pipeline makes.
class EstimateSink {
 public:
  virtual ~EstimateSink() = default;
  /// A pose, stamps ascending. `prior` is the newest prior when it was made.
  virtual void on_pose(const PoseEstimate& pose, const Prior& prior) = 0;
};

class LockStep {
 public:
  /// `shelf`: takes the tiles that leave memory; null: they are forgotten.
  LockStep(const StageSettings& settings, EstimateSink& sink, TileShelf* shelf = nullptr);

  void handle(const recording::Event& event);
  /// Registers what still waits and puts the rest of the map on the shelf. Call once, at the end.
  void finish();

  [[nodiscard]] const velodyne::VelodyneDecoder& decoder() const { return decoder_; }
  [[nodiscard]] const PriorEstimator& prior_estimator() const { return prior_estimator_; }
  [[nodiscard]] const LocalMap& map() const { return map_; }
  [[nodiscard]] std::uint64_t scans() const { return scans_; }

 private:
  void take_packet(const recording::Event& event);
  void take_imu(const ImuSample& sample);
  void queue_scan();
  void register_waiting(bool even_without_prior);
  void register_oldest();
  void bridge_silence();
  void emit(const PoseEstimate& pose, bool from_scan);

  EstimateSink& sink_;
  velodyne::VelodyneDecoder decoder_;
  PriorEstimator prior_estimator_;
  Registration registration_;
  LocalMap map_;

  std::unique_ptr<Scan> filling_;
  std::deque<std::unique_ptr<Scan>> waiting_;
  std::vector<std::unique_ptr<Scan>> spare_;
  RegisteredScan registered_;
  Prior newest_prior_;
  SilenceBridge silence_;
  std::uint64_t scans_ = 0;
};

}  // namespace isobar
