// SPDX-License-Identifier: BSD-3-Clause
// One scan in, one pose out:
//
//     prior at the scan's end ─▶ prediction ─▶ deskewed, thinned scan ─▶ ICP ─▶ gate ─▶ pose
//     (PriorHistory)           (MotionModel)   (prepare_scan)      (ScanMatcher)
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/estimates.hpp"
#include "core/geometry.hpp"
#include "core/map/map_snapshot.hpp"
#include "core/mounts/level_surfaces.hpp"
#include "core/mounts/mount_estimator.hpp"
#include "core/prior/prior_history.hpp"
#include "core/registration/dead_reckoning_error.hpp"
#include "core/registration/halt_turn.hpp"
#include "core/registration/held_pose.hpp"
#include "core/registration/hint_trial.hpp"
#include "core/registration/known_place.hpp"
#include "core/registration/lost_detector.hpp"
#include "core/registration/map_drift.hpp"
#include "core/registration/map_height.hpp"
#include "core/registration/method.hpp"
#include "core/registration/motion_model.hpp"
#include "core/registration/mount_doubt.hpp"
#include "core/registration/place_hint.hpp"
#include "core/registration/place_search.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"
#include "core/registration/scan_preparation.hpp"
#include "core/registration/speed_search.hpp"
#include "core/registration/tilt_offset.hpp"

namespace isobar {

/// A robot that is lost, see PoseEstimate::lost.
struct LostState {
  LostReason reason = LostReason::kNone;
  std::int64_t since_ns = 0;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();   ///< dead-reckoned at the start
  Eigen::Isometry3d T_odom_base = Eigen::Isometry3d::Identity();  ///< the prior's, there
  bool has_height = false;                                        ///< the prior's height carries z
  double height_m = 0.0;                                          ///< there
  double error_m = 0.0;                                           ///< of position there, 1 sigma
  double error_rad = 0.0;                                         ///< of attitude
  double matched_overlap = 0.0;                                   ///< of the scans before, smoothed; 0: none
  double matched_rms_m = 0.0;                                     ///< the same
};

/// What a Registration has learnt, and another one with other settings takes over.
struct RegistrationState {
  RegistrationState(const RegistrationConfig& config, const Eigen::Quaterniond& configured)
      : motion(config),
        tilt(config.mount_error_deg * kRadPerDeg),
        mounts(configured),
        yaw_mounts(configured),
        mount_doubt(config.mount_error_deg * kRadPerDeg / std::sqrt(2.0)),
        q_base_lidar(configured) {}

  PriorHistory history;
  MotionModel motion;
  MapHeight height;
  MapDrift drift;
  DeadReckoningError unseen;  ///< since the last registered scan
  HaltTurn halt;
  bool posed = false;  ///< `last` is a pose of this frame
  TiltOffset tilt;
  MountEstimator mounts;
  MountEstimator yaw_mounts;  ///< of methods that fix roll and pitch: yaw only
  MountDoubt mount_doubt;
  Eigen::Quaterniond q_base_lidar;  ///< as found so far
  HeldPose held;
  SpeedSearch speed;
  double wheel_turn_rad = 0.0;  ///< Prior::wheel_turn_rad of the last registered scan
  PlaceSearch search;
  HintTrial hint;
  LostDetector lost_detector;
  LostState lost;
  std::int64_t ground_since_ns = 0;  ///< methods that ask no altimeter: start of a ride; 0: none
  double scan_height_m = 0.0;        ///< Prior::height_m at the last scan
  double risen_variance_m2 = 0.0;    ///< of z, from moving ground
  std::optional<KnownPlace> place;
  MapMove map_move;                ///< of the map of the last scan
  std::optional<KnownPlace> home;  ///< see Registration::stay_in()
  bool waits_for_place = false;    ///< see Registration::wait_for_place()
  bool awaits_place = false;       ///< no search around the last place has found it, or none was made
  bool place_given_up = false;
  PoseEstimate last;
  std::int64_t first_prior_ns = 0;  ///< 0: none yet; the history forgets
  std::uint32_t scans_without_gravity = 0;
  std::int64_t level_since_ns = 0;  ///< start of the halt in which level surfaces are looked for; 0: none yet
  std::uint32_t bootstrap_scans = 0;
  bool bootstrapping = true;  ///< no scan has been registered yet
};

/// Registers scans to the map, starting from the prior. Allocates in its constructor only. Not thread-safe.
class Registration {
 public:
  /// `T_base_lidar`: pose of the lidar in base_link.
  Registration(const RegistrationConfig& config, Method method, const Eigen::Isometry3d& T_base_lidar);

  /// Number of the first map frame, before the first scan.
  void set_session(std::uint32_t session) { state_.last.session = session; }
  /// Continues in a known map, before the first scan: the place is searched around the last one, and scans
  /// stay out of the map until it is confirmed. If it is not, begin_new_frame().
  void resume(const KnownPlace& place);
  /// Begins a new map frame with the next scan, at x = y = yaw = 0, and increments session(). The height
  /// keeps its datum. Forgets the priors, whose clock may have started over.
  void begin_new_frame();
  /// Number of the map frame, 1 …
  [[nodiscard]] std::uint32_t session() const { return state_.last.session; }
  /// The place of resume() is not confirmed yet.
  [[nodiscard]] bool searching() const {
    return state_.place.has_value() || state_.awaits_place || (state_.search.active() && !lost());
  }

  /// Somebody searches the whole map. Where no scan confirms the place of resume(), the robot then waits for a hint() or
  /// for give_up_place(), instead of beginning a new map frame. Before the first scan.
  void wait_for_place(bool waits) { state_.waits_for_place = waits; }
  /// The place cannot be found: if it is still searched and no hint is tried, a new map frame begins with the next scan.
  /// No effect after stay_in().
  void give_up_place() { state_.place_given_up = searching() && !state_.home; }
  /// The map frame is that of a stored map for the whole run: begin_new_frame() searches the place in it anew, at `place`,
  /// which is anywhere. Before the first scan.
  void stay_in(const KnownPlace& place) { state_.home = place; }

  /// Somebody says where the robot is. The next scans are tried there; the robot goes on from there only where they
  /// match, and otherwise nothing changes. Instead of an earlier hint. See hint_report().
  void hint(const PlaceHint& hint);
  /// A hint waits, or is tried.
  [[nodiscard]] bool has_hint() const { return state_.hint.active() || state_.hint.waiting() != nullptr; }
  [[nodiscard]] const HintReport& hint_report() const { return state_.hint.report(); }

  /// Appends a prior; priors come in order of time.
  void add_prior(const Prior& prior);

  /// Takes over what another Registration with other settings has learnt: the pose goes on. Allocates nothing,
  /// except while a place is searched.
  void take_over(const Registration& other);

  /// True where the priors reach the end of the scan: register_scan() then extrapolates nothing.
  [[nodiscard]] bool ready(const Scan& scan) const;

  /// Estimates the pose at the end of `scan` against `map`; writes pose and deskewed, thinned points to
  /// `out`. Never fails: a scan that cannot be registered gets the predicted pose and mode kPriorOnly.
  void register_scan(const Scan& scan, const MapSnapshot& map, RegisteredScan& out);

  /// Pose at the newest prior, between scans and while the lidar is silent. False before the first scan with
  /// a pose in the map.
  bool propagate(PoseEstimate& out) const;

 private:
  [[nodiscard]] const MethodTraits& traits_for(const Prior& prior) const;
  [[nodiscard]] const MethodTraits& traits_of_search(const Prior& prior) const;
  [[nodiscard]] PoseEstimate description_of(const Prior& prior, const MethodTraits& traits) const;
  [[nodiscard]] Prior prior_at(std::int64_t stamp_ns) const;
  [[nodiscard]] Prior prior_without_imu(std::int64_t stamp_ns) const;
  bool start_motion(const Scan& scan, const Prior& prior, RegisteredScan& out);
  bool find_level(const Scan& scan, const Prior& prior, RegisteredScan& out);
  [[nodiscard]] bool knows(const MapSnapshot& map) const {
    return !map.empty() && map.session() == session();
  }
  // registration_lost.cpp
  [[nodiscard]] bool lost() const { return state_.lost.reason != LostReason::kNone; }
  void rise_with_ground(const Prior& end, const MethodTraits& traits, Prediction& prediction);
  [[nodiscard]] double height_before_ride(std::int64_t stamp_ns) const;
  void describe_ground(const Prior& end, PoseEstimate& pose) const;
  void watch(const Prior& end, PoseEstimate& pose);
  void begin_lost(const Prior& end, LostReason reason, PoseEstimate& pose);
  void search_around(const Prior& end);
  void find_again(PoseEstimate& pose);
  void search_lost(const MapSnapshot& map, const Prior& end, const Prediction& expected, RegisteredScan& out);
  void describe_lost(const Prior& end, PoseEstimate& pose) const;
  [[nodiscard]] Eigen::Isometry3d dead_reckoned(const Prior& end) const;
  [[nodiscard]] bool plausible(const Prior& end, const Eigen::Isometry3d& T_map_base) const;
  // registration_place.cpp
  void follow_map(const MapSnapshot& map);
  void next_frame();
  bool start_at_place(const Prior& prior);
  void search_place(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                    RegisteredScan& out);
  void await_place(const Prior& end, const Prediction& expected, PoseEstimate& pose);
  void leave_unknown_place(PoseEstimate& pose);
  PlaceVerdict try_hypotheses(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                              const MethodTraits& traits, std::size_t per_scan);
  PlaceVerdict confirm_place(const MapSnapshot& map, const Prior& end, const Prediction& expected,
                             const MethodTraits& traits, PoseEstimate& pose);
  [[nodiscard]] static Prediction with_height_error(Prediction prediction, const Prior& prior);
  // registration_hint.cpp
  void begin_hint(const MapSnapshot& map, const Prior& end, const Eigen::Isometry3d& T_believed);
  PlaceVerdict judge_hint(const MapSnapshot& map, const Prior& end, const Prediction& prediction,
                          std::size_t per_scan, MatchResult& found);
  void search_hint(const MapSnapshot& map, const Prior& end, const Prediction& expected, RegisteredScan& out);
  void try_hint_beside(const MapSnapshot& map, const Prior& end, const Prediction& prediction,
                       PoseEstimate& pose);
  void go_on_from(const Prior& end, const MatchResult& found, PoseEstimate& pose);
  [[nodiscard]] MatchResult match(const MapSnapshot& map, const Prior& prior, const Prediction& prediction,
                                  const MethodTraits& traits);
  [[nodiscard]] bool acceptable(const MatchResult& match, const Prediction& prediction) const;
  [[nodiscard]] Prediction predict(const Prior& end, const MethodTraits& traits);
  void learn(const Prior& end, const Prediction& prediction, const MethodTraits& traits, bool registered,
             PoseEstimate& pose);
  void learn_mount(const Prior& end, const MethodTraits& traits, const PoseEstimate& pose);
  void use_mount();
  void describe_mount(PoseEstimate& pose) const;
  void own_tilt(const Prior& end, PoseEstimate& pose);
  void own_height(const Prediction& prediction, bool registered, PoseEstimate& pose);
  void continue_from(const Prior& end, const Prediction& prediction, bool registered,
                     const PoseEstimate& pose);
  // registration_speed.cpp
  bool search_speed(const MapSnapshot& map, const Prior& end, const MethodTraits& traits,
                    Prediction& prediction, PoseEstimate& pose);
  void wait_for_speed(const Prediction& standing, double after_s, PoseEstimate& pose);
  MatchResult match_by_own_motion(const Scan& scan, const MapSnapshot& map, const Prior& end,
                                  const MethodTraits& traits, const Prediction& prediction,
                                  RegisteredScan& out);
  // registration_covariance.cpp
  void restart_drift(const Prior& prior);
  void own_covariance(const Prior& end, const MethodTraits& traits, bool registered, PoseEstimate& pose);
  void lay_scan(const MethodTraits& traits, const Matrix6d& scan_covariance, PoseEstimate& pose);
  void watch_halt(const Prior& end, const PoseEstimate& pose);
  [[nodiscard]] UnseenStep step_to(const Prior& end, const Eigen::Isometry3d& T_map_base) const;
  [[nodiscard]] double height_variance() const;
  void fix_variances(const Prior& prior, const MethodTraits& traits, Matrix6d& covariance) const;
  // registration_mount_error.cpp
  [[nodiscard]] static double unsettled_gravity_rad(const Prior& prior);
  [[nodiscard]] double offset_sigma_rad() const;
  [[nodiscard]] Matrix6d mount_covariance(const Prior& end, const MethodTraits& traits,
                                          const Eigen::Isometry3d& T_map_base) const;
  /// The pose of a registered scan: the scan's, or that of a robot that stands.
  Eigen::Isometry3d registered_pose(const Prior& end, const MethodTraits& traits, const MatchResult& result);
  [[nodiscard]] PoseMode mode_after(bool registered, const MethodTraits& traits);

  RegistrationConfig config_;
  Method asked_;
  Eigen::Isometry3d T_base_lidar_;  // as configured
  MethodTraits traits_;             // without a height
  MethodTraits traits_with_height_;
  MethodTraits traits_of_free_height_;  // search of the place: 3-DOF with z
  MethodTraits traits_without_imu_;     // IMU silent: the motion comes from the scans alone
  RegistrationState state_;
  Deskewer deskewer_;
  Sampler sampler_;
  LevelSurfaces level_;
  ScanMatcher matcher_;
};

}  // namespace isobar
