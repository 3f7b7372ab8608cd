// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "daemon/floor_grid_publisher.hpp"
#include "daemon/floor_stage.hpp"
#include "daemon/seq_lock.hpp"
#include "daemon/worker.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {

/// Status of the thread of the floors.
struct FloorStatus {
  bool started = false;  ///< a pose has come
  ipc::CurrentFloor floor;
  double sigma_m = 0.0;           ///< of the height of the newest pose
  double round_ms = 0.0;          ///< CPU time of the last search for floors, with its grid
  bool grid_too_large = false;    ///< the last grid was refused
  bool names_unreadable = false;  ///< floors.toml breaks a rule; the names before it hold
};

/// Tells the floor, and makes its grid, beside the pipeline and without its priority: the scans do not wait for it. Its
/// rounds are so far apart that they take FloorSettings::cpu_share of a core at most.
class FloorThread {
 public:
  /// Folder of the map of a map frame; empty: none.
  using MapFolder = std::function<std::filesystem::path(std::uint32_t session)>;

  /// @param feed points of the map; outlives the thread
  FloorThread(const FloorSettings& settings, FloorFeed& feed, MapFolder map_folder,
              ThreadSettings scheduling);

  [[nodiscard]] Worker& worker() noexcept { return worker_; }
  [[nodiscard]] FloorStatus status() const noexcept { return status_.get(); }

 private:
  void loop() noexcept;
  void drain() noexcept;
  void take_poses();
  void begin_session(std::uint32_t session);
  void follow_names(std::int64_t now_ns);
  void run_round(std::int64_t now_ns);
  [[nodiscard]] bool round_is_due(std::int64_t now_ns) const;
  [[nodiscard]] std::int64_t wait_ns() const;
  void offer_grid(const ipc::CurrentFloor& floor, std::int64_t now_ns);
  void publish(const ipc::CurrentFloor& floor, std::int64_t now_ns);
  void publish_known(std::int64_t now_ns);

  FloorSettings settings_;
  FloorFeed& feed_;
  MapFolder map_folder_;
  FloorStage stage_;
  FloorGridPublisher grids_;
  ipc::Publisher<ipc::CurrentFloor> floors_{ipc::topics::kFloor};
  ipc::Publisher<ipc::KnownFloors> lists_{ipc::topics::kKnownFloors};
  ipc::Subscriber<PoseEstimate> poses_{ipc::topics::kPose};
  ipc::Waiter waiter_;

  bool map_is_whole_ = false;                              ///< the feed has answered since the last round
  bool asked_ = false;                                     ///< the feed, since the last round
  std::int64_t round_ns_ = 0;                              ///< end of the last round, robot clock
  double cpu_ms_ = 0.0;                                    ///< of the last round and the grids since
  unsigned equal_grids_ = 0;                               ///< in sequence, while the robot stood
  Eigen::Vector3d p_map_round_ = Eigen::Vector3d::Zero();  ///< place of the robot at the last round
  std::uint32_t grid_session_ = 0;                         ///< of the last grid
  std::int32_t grid_floor_ = 0;
  ipc::CurrentFloor published_;
  std::int64_t published_ns_ = 0;
  ipc::KnownFloors listed_;   ///< as published
  bool list_is_old_ = false;  ///< floors or their names were found or read since
  std::int64_t listed_ns_ = 0;
  std::filesystem::path folder_;  ///< of the map
  std::int64_t names_ns_ = 0;     ///< when the names were looked at
  std::filesystem::file_time_type names_changed_{};
  FloorStatus draft_;
  SeqLock<FloorStatus> status_;
  Worker worker_;
};

/// Adds the entry "floor" to a health report, and the floor to its figures.
void add_floor(const FloorStatus& floor, ipc::HealthReport& report);

}  // namespace isobar
