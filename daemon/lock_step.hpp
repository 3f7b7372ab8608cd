// SPDX-License-Identifier: BSD-3-Clause
// The pipeline in lock step: every sample passes all stages before the next one. No scan is dropped, and the
// same input gives the same output, bit for bit. The live daemon runs the same stages, one thread each.
//
//   packets ─▶ decoder ─▶ scan ──────────────┐
//   samples ─▶ prior estimator ─▶ prior ─────┴▶ registration ─▶ pose, registered scan ─▶ map ─▶ snapshot
//                                                                            └─▶ loops ─▶ corrections
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/estimates.hpp"
#include "core/map/local_map.hpp"
#include "core/prior/prior_estimator.hpp"
#include "core/prior/prior_pace.hpp"
#include "daemon/cloud_scans.hpp"
#include "daemon/lidar_sender.hpp"
#include "daemon/loop_stage.hpp"
#include "daemon/place_stage.hpp"
#include "daemon/registration_stage.hpp"
#include "daemon/run_start.hpp"
#include "daemon/scan_queue.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {

/// The pipeline in lock step, in the caller's thread.
class LockStep {
 public:
  /// Puts a map that was laid anew in the place of the map, and opens its tiles.
  using MapExchange = std::function<TileStorage*()>;
  /// @param sink receives the poses
  /// @param storage takes the tiles that leave memory; null: they are discarded
  /// @param loop_files keeps the building, whose loops then move the map; null: only the trajectory is corrected
  LockStep(const StageSettings& settings, EstimateSink& sink, TileStorage* storage = nullptr,
           std::unique_ptr<LoopFiles> loop_files = nullptr, MapExchange exchange = {});

  /// What the pipeline needs of the folders of its maps, if a robot shall be found in the whole map.
  struct Maps {
    /// Storage of a further map frame; null: its tiles are discarded.
    std::function<TileStorage*(std::uint32_t session)> open;
    /// The whole map of a frame, as far as it is in the storage.
    MapReader read;
  };
  /// Before continue_from() and localise_in().
  void use_maps(Maps maps) { maps_ = std::move(maps); }
  /// Continues in a stored map that stays as it is: no scan is inserted, and no new map frame begins.
  void localise_in(const RunStart& start);

  /// Continues an earlier run, before the first event, with the tiles of the storage around its place and the
  /// scans of the journal in the folder of its map.
  void continue_from(const RunStart& start, const std::filesystem::path& map_folder);
  void handle(const recording::Event& event);
  /// Registers the waiting scans and stores the tiles in memory. Call once, at the end.
  void finish();

  [[nodiscard]] const ScanAssembler& assembler() const { return assembler_; }
  [[nodiscard]] const CloudScans& clouds() const { return clouds_; }
  [[nodiscard]] const SenderStatus& lidar_sender() const { return sender_.status(); }
  [[nodiscard]] const PriorEstimator& prior_estimator() const { return prior_estimator_; }
  [[nodiscard]] LocalMap& map() { return *map_; }
  [[nodiscard]] const LocalMap& map() const { return *map_; }
  /// The last scan and its pose, as the map got them.
  [[nodiscard]] const RegisteredScan& registered_scan() const { return registered_; }
  [[nodiscard]] std::uint64_t scans() const { return scans_; }
  /// Places that were seen again, and what they correct.
  [[nodiscard]] const LoopStage& loops() const { return loops_; }
  /// The search of the place in the whole map.
  [[nodiscard]] const PlaceStatus& place() const { return place_.status(); }

 private:
  void take_packet(const recording::Event& event);
  void take_cloud(const recording::CloudRecord& cloud);
  void take_imu(const ImuSample& sample);
  void advance(std::int64_t now_ns);
  void use_prior(const Prior& prior);
  void queue_scan();
  void register_admissible();
  void exchange_map(std::optional<MovedMap> moved);
  void insert_scan();
  void find_place();
  [[nodiscard]] std::shared_ptr<const KnownMap> read_map(std::uint32_t session);

  LidarSender sender_;
  ScanAssembler assembler_;
  CloudScans clouds_;
  PriorEstimator prior_estimator_;
  RegistrationStage registration_;
  MapConfig map_config_;
  Eigen::Isometry3d T_base_lidar_;
  std::unique_ptr<LocalMap> map_;  ///< never null
  MapExchange exchange_;
  Maps maps_;
  bool localises_ = false;  ///< the map is only used
  LoopStage loops_;
  PlaceStage place_;

  std::int64_t clock_ns_ = 0;  ///< stands still until finish(): scans wait for priors without a time limit
  std::unique_ptr<Scan> filling_;
  ScanQueue<std::unique_ptr<Scan>> queue_;
  std::vector<std::unique_ptr<Scan>> spare_;
  RegisteredScan registered_;
  std::uint64_t scans_ = 0;
  bool has_imu_;
  bool uses_wheels_;
  bool imu_of_lidar_;
  PriorPace pace_;  ///< without an IMU
};

}  // namespace isobar
