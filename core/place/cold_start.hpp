// SPDX-License-Identifier: BSD-3-Clause
// Where in a known map a robot is that knows nothing but gravity, its height and what it sees:
//
//     query ─▶ slab at the height ─▶ correlative search ─▶ coarse fit ─▶ ICP ─▶ fine fit ─▶ verdict
//                                    (all places)          (choice)     (few)
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/place/correlative_search.hpp"
#include "core/place/known_map.hpp"
#include "core/place/place_fit.hpp"
#include "core/place/place_query.hpp"
#include "core/place/slab_image.hpp"
#include "core/place/slab_pyramid.hpp"
#include "core/registration/method.hpp"
#include "core/registration/registration_config.hpp"
#include "core/registration/scan_matcher.hpp"

namespace isobar {

enum class ColdStartVerdict : std::uint8_t {
  kFound,        ///< one place fits, and no other nearly as well
  kAmbiguous,    ///< several fit
  kUnknown,      ///< none fits: the robot is not in the map, or sees too little
  kHintRefused,  ///< none fits near the hint
};

/// A place that fits.
struct PlaceCandidate {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_map_level = Eigen::Isometry3d::Identity();  ///< the same without roll and pitch
  double weight = 0.0;  ///< probability among the candidates, 0 … 1
  PlaceFit fit;
};

struct ColdStartResult {
  ColdStartVerdict verdict = ColdStartVerdict::kUnknown;
  std::vector<PlaceCandidate> candidates;  ///< the likeliest first; kFound: the first is the pose
  bool complete = true;                    ///< false: the time was over before all places had been tried
  std::size_t tried = 0;                   ///< hypotheses of the search
};

/// Part of the map to which a search is limited: 3 sigma around a pose that somebody names.
struct SearchArea {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  Eigen::Vector2d sigma_m = Eigen::Vector2d::Ones();  ///< of x and y
  double sigma_yaw_rad = 1.0;
};

/// Limits of the judgement. The defaults were found by tests/benchmark/place.
struct ColdStartConfig {
  SearchLimits search;
  /// Hypotheses with the best coarse fit, to which the ICP is applied.
  std::size_t refined = 14;
  /// Candidates that are kept.
  std::size_t most_candidates = 16;
  /// Least fit of a place that may be the right one.
  double least_fit = 0.6;
  /// Weight of a candidate above which there is no doubt.
  double certain_weight = 0.97;
};

/// What is known of a standing robot besides its scans.
struct ColdStartInput {
  const KnownMap& map;
  const PlaceQuery& query;
  /// Rotation from base_link to the level frame of the query: roll and pitch of gravity.
  Eigen::Matrix3d R_level_base;
  SlabHeight height;  ///< of base_link, by air pressure, in the map's datum
};

/// Global localisation. locate() searches the whole map; follow() takes what the robot sees after it has driven on, and
/// narrows the candidates. Buffers are kept between calls. Not thread-safe; not for a real-time thread.
class ColdStart {
 public:
  explicit ColdStart(const ColdStartConfig& config = {}, const RegistrationConfig& registration = {});

  /// Searches all places, or those near `hint`. A height or a hint that is not finite fits nowhere.
  const ColdStartResult& locate(const ColdStartInput& input, const std::optional<SearchArea>& hint = {});
  /// After a motion by odometry since the last call: `T_before_now`, pose of the query's level frame in that of the
  /// query before, a rotation about z. Candidates that do not fit any more are dropped; the verdict is kUnknown when none is
  /// left, and locate() begins anew.
  const ColdStartResult& follow(const ColdStartInput& input, const Eigen::Isometry3d& T_before_now);
  [[nodiscard]] const ColdStartResult& result() const { return result_; }

 private:
  struct Hypothesis {
    SlabPose pose;
    double z_m = 0.0;
    double fit = 0.0;
  };

  void search_slab(const ColdStartInput& input, const SlabHeight& height,
                   const std::optional<SearchArea>& hint);
  void refine(const ColdStartInput& input, const SlabHeight& height);
  /// A candidate, and what speaks for it. Until judge() its weight is a logarithm of what else is known of it.
  struct Judged {
    PlaceCandidate candidate;
    PlaceEvidence evidence;
    [[nodiscard]] double score() const { return evidence.sum() + candidate.weight; }
  };
  [[nodiscard]] std::optional<Judged> refined(const ColdStartInput& input, const SlabHeight& height,
                                              const Eigen::Isometry3d& T_map_level, double error_m);
  [[nodiscard]] std::optional<Judged> matched(const ColdStartInput& input, const SlabHeight& height,
                                              const Eigen::Isometry3d& T_map_level, double error_m);
  void add_candidate(Judged candidate);
  void judge(const ColdStartInput& input, bool hinted);
  void settle(const ColdStartInput& input);

  ColdStartConfig config_;
  RegistrationConfig registration_;
  MethodTraits traits_;
  SlabImage image_;
  SlabPyramid pyramid_;
  CorrelativeSearch search_;
  ScanMatcher matcher_;
  std::vector<PlaneMatch> matches_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<Judged> judged_;
  ColdStartResult result_;
};

}  // namespace isobar
