// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/estimates.hpp"
#include "core/place/cold_start.hpp"
#include "core/registration/place_hint.hpp"
#include "daemon/carried_watch.hpp"
#include "daemon/place_status.hpp"
#include "daemon/run_start.hpp"
#include "daemon/stage_settings.hpp"

namespace isobar {

/// Reads the whole map of a map frame. Null: there is none.
using MapReader = std::function<std::shared_ptr<const KnownMap>(std::uint32_t session)>;

/// What the search asks of the registration.
struct PlaceOrder {
  /// Where the odometry's frame is in the map: a place was found, and is to be tried.
  std::optional<Eigen::Isometry3d> T_map_odom;
  bool give_up = false;  ///< the place is none of the map

  /// The place found as a hint, at the time of `pose`. Requires T_map_odom.
  [[nodiscard]] PlaceHint hint_at(const PoseEstimate& pose) const;
};

/// Search of the place in the whole map, as a stage: registered scans and priors in, hints out. Works only while the
/// registration does not know the place: after the start in a known map, when the robot is lost, and when it may have been
/// carried away. Live runs (PlaceThread)
/// and replay (LockStep) run this same object. Not on the way of a scan: it allocates, and takes up to seconds. One thread.
class PlaceStage {
 public:
  PlaceStage(const StageSettings& settings, MapReader read_map);

  /// The place of `start` is searched, if it has one. `stays`: in a stored map, which no new frame replaces.
  void begin_at(const RunStart& start, bool stays);
  /// Takes a prior; in order of time. The last one before a scan has the height of the air at it.
  void add_prior(const Prior& prior) { prior_ = prior; }
  /// Stamp of the last prior; 0: none yet.
  [[nodiscard]] std::int64_t prior_ns() const { return prior_.stamp_ns; }
  PlaceOrder add_scan(const RegisteredScan& scan);

  [[nodiscard]] const PlaceStatus& status() const { return status_; }

 private:
  /// A scan in axes of base_link, with the odometry at its end.
  struct OdometryScan {
    Eigen::Isometry3d T_odom_base;
    std::vector<Eigen::Vector3f> p_base;
  };

  [[nodiscard]] bool is_needed(const PoseEstimate& pose) const;
  void watch(const PoseEstimate& pose);
  [[nodiscard]] PlaceOrder continue_search(const RegisteredScan& scan);
  void note_refusal(const PoseEstimate& pose);
  void begin_search(const PoseEstimate& pose);
  void end_search();
  void collect(const RegisteredScan& scan);
  [[nodiscard]] bool is_due(std::int64_t stamp_ns) const;
  [[nodiscard]] bool is_over() const;
  void search(const PoseEstimate& pose);
  void fill_query(const Eigen::Isometry3d& T_odom_level);
  [[nodiscard]] SlabHeight height();
  void take(const ColdStartResult& result, std::int64_t stamp_ns);
  void tell(const Eigen::Isometry3d& T_map_odom, std::int64_t stamp_ns);
  [[nodiscard]] bool is_at_found_place(const PoseEstimate& pose) const;
  void take_carried(const ColdStartResult& result, const PoseEstimate& pose);
  void describe(const ColdStartResult& result);

  Eigen::Isometry3d T_base_lidar_;
  MapReader read_map_;
  ColdStart cold_start_;
  PlaceQuery query_;
  std::shared_ptr<const KnownMap> map_;
  Prior prior_;

  bool searches_start_ = false;  // begin_at() with a place
  bool around_first_ = false;    // the registration searches around the last place meanwhile
  bool stays_ = false;
  bool height_is_of_map_ = false;  // z of the map is the prior's height + z_above_height_m_
  double z_above_height_m_ = 0.0;
  double last_z_m_ = 0.0;  // of the last pose in the map

  CarriedWatch carried_watch_;
  bool carried_ = false;                      // the robot may have been carried away
  int looks_ = 0;                             // searches since then
  std::optional<Eigen::Isometry3d> seen_at_;  // T_map_odom of the place found by the first of two looks

  std::int64_t began_ns_ = 0;  // of this search; 0: none
  std::int64_t told_ns_ = 0;   // of a place found, whose confirmation is awaited; 0: none
  std::int64_t asked_ns_ = 0;  // of the last search; 0: none
  Eigen::Isometry3d T_odom_asked_ = Eigen::Isometry3d::Identity();  // level frame of the last query
  std::vector<OdometryScan> scans_;
  int unknown_ = 0;  // searches in a row that found no place
  std::optional<Eigen::Isometry3d> found_;
  PlaceStatus status_;
};

}  // namespace isobar
