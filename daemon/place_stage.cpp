// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/place_stage.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/loops/submap.hpp"
#include "core/place/place_grid.hpp"
#include "core/so3.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"
#include "daemon/cpu_time.hpp"
#include "daemon/place_frames.hpp"

namespace isobar {

namespace {

// Scans of one query. Three of a VLP-16 show nine places of ten (docs/place.md).
constexpr std::size_t kScans = 3;
constexpr std::uint32_t kLeastPoints = 500;
// Time that the registration has for its own search: around the last place of a run that is continued, and around the
// dead-reckoned one of a robot that is lost.
constexpr double kAroundLastS = 2.5;
constexpr double kAroundLostS = 5.0;
// What the robot sees is another thing after this way or turn, and people have moved after this time.
constexpr double kNextViewM = 1.0;
constexpr double kNextViewRad = 45.0 * kRadPerDeg;
constexpr double kNextTimeS = 3.0;
// A place that the registration has not confirmed by then is refused: the tiles around it are read within a
// second, nine hypotheses and three scans take 0.4 s at 10 Hz.
constexpr double kConfirmedWithinS = 4.0;
// Bounds after which a robot whose place is ambiguous, or that sees too little, begins a new map frame, and the number of
// searches without any place after which it does.
constexpr double kLongestWayM = 40.0;
constexpr double kLongestSearchS = 120.0;
constexpr double kLongestBlindS = 30.0;
constexpr int kUnknownSearches = 2;
// Fit of a place that is tried. Right places of second sessions fit to 0.88 … 0.97, the best one of another building to 0.63.
constexpr double kLeastFit = 0.75;
// Error of the height by air pressure in the datum of the map, 1 sigma: zones of ventilation, doors, noise. The largest one
// that still tells one slab.
constexpr double kLeastHeightSigmaM = 0.15;
constexpr double kLargestHeightSigmaM = 0.33;
// The same where weather and height cannot be told apart.
constexpr double kUnknownHeightM = 10.0;
// Height above the highest and below the lowest part of the map from which the pressure is that of another base station, and not
// of a floor that the map does not have.
constexpr double kOutsideMapM = 25.0;
struct Extent {
  double low_m = 0.0;
  double high_m = 0.0;
};

Extent heights_of(const StructureMap& map) {
  Extent extent{1e9, -1e9};
  for (const auto& [key, tile] : map.tiles()) {
    extent.low_m = std::min(extent.low_m, tile.low.z * static_cast<double>(kPlaceCellM));
    extent.high_m = std::max(extent.high_m, tile.high.z * static_cast<double>(kPlaceCellM));
  }
  return extent;
}

}  // namespace

PlaceHint PlaceOrder::hint_at(const PoseEstimate& pose) const {
  const Eigen::Isometry3d T_map_base = *T_map_odom * odometry_of(pose);
  const Eigen::Vector3d p = T_map_base.translation();
  return {.session = pose.session,
          .p_map_m = p.head<2>(),
          .has_z = true,
          .z_m = p.z(),
          .z_sigma_m = 0.1,
          .z_is_sure = true,
          .yaw_rad = yaw_of(T_map_base.linear()),
          .sigma_m = 0.2,
          .sigma_rad = 0.05};
}

PlaceStage::PlaceStage(const StageSettings& settings, MapReader read_map)
    : T_base_lidar_(settings.T_base_lidar),
      read_map_(std::move(read_map)),
      cold_start_({}, settings.registration) {}

void PlaceStage::begin_at(const RunStart& start, bool stays) {
  stays_ = stays;
  searches_start_ = start.place.has_value();
  if (!start.place) return;
  around_first_ = !start.place->anywhere;
  height_is_of_map_ = start.place->has_height;
  last_z_m_ = start.place->T_map_base.translation().z();
  z_above_height_m_ = last_z_m_ - start.place->height_m;
}

bool PlaceStage::is_needed(const PoseEstimate& pose) const {
  const bool starts = searches_start_ && place_unknown(pose) && pose.covariance(0, 0) > 0.0;
  return read_map_ &&
         (starts || carried_ || pose.lost == LostReason::kTurn || pose.lost == LostReason::kTilt);
}

PlaceOrder PlaceStage::add_scan(const RegisteredScan& scan) {
  const PoseEstimate& pose = scan.pose;
  if (!is_needed(pose)) {
    if (began_ns_ != 0) end_search();
    watch(pose);
    if (!carried_) return {};
  }
  return continue_search(scan);
}

PlaceOrder PlaceStage::continue_search(const RegisteredScan& scan) {
  const PoseEstimate& pose = scan.pose;
  if (began_ns_ == 0) begin_search(pose);
  status_.waited_s = seconds_between(began_ns_, pose.stamp_ns);
  const bool sees = scan.point_count >= kLeastPoints;
  if (sees) collect(scan);
  if (told_ns_ != 0) {
    if (seconds_between(told_ns_, pose.stamp_ns) < kConfirmedWithinS) return {};
    note_refusal(pose);
  }
  if (began_ns_ != 0 && sees && is_due(pose.stamp_ns)) search(pose);
  if (began_ns_ == 0) return {};
  PlaceOrder order{std::exchange(found_, {}), false};
  if (!order.T_map_odom && told_ns_ == 0 && is_over()) {
    order.give_up = true;
    status_.given_up += status_.state == PlaceState::kGivenUp ? 0 : 1;
    status_.state = PlaceState::kGivenUp;
  }
  return order;
}

// The registration has not confirmed the place in time. A robot that knew its place may have gone on there.
void PlaceStage::note_refusal(const PoseEstimate& pose) {
  told_ns_ = 0;
  const bool went_on = status_.carried && is_at_found_place(pose);
  status_.refused += went_on ? 0 : 1;
  ++unknown_;
  status_.state = PlaceState::kUnknown;
  if (status_.carried) end_search();
}

void PlaceStage::begin_search(const PoseEstimate& pose) {
  began_ns_ = pose.stamp_ns;
  told_ns_ = asked_ns_ = 0;
  unknown_ = 0;
  status_.state = PlaceState::kCollecting;
  status_.lost = pose.lost != LostReason::kNone;
  status_.carried = carried_ && !status_.lost;
  looks_ = 0;
  seen_at_.reset();
  // Before the scans of another place are in it.
  if (status_.carried) map_ = read_map_(pose.session);
  status_.waited_s = status_.driven_m = 0.0;
}

void PlaceStage::end_search() {
  began_ns_ = told_ns_ = 0;
  searches_start_ = searches_start_ && stays_;
  carried_ = status_.carried = false;
  carried_watch_.restart();
  scans_.clear();
  map_.reset();
  status_.state = PlaceState::kIdle;
  status_.hypothesis_count = 0;
}

void PlaceStage::collect(const RegisteredScan& scan) {
  const Eigen::Isometry3d T_odom_base = odometry_of(scan.pose);
  if (!scans_.empty()) {
    const Eigen::Vector3d step_m = T_odom_base.translation() - scans_.back().T_odom_base.translation();
    status_.driven_m += step_m.head<2>().norm();
  }
  if (scans_.size() == kScans) scans_.erase(scans_.begin());
  OdometryScan& one = scans_.emplace_back();
  one.T_odom_base = T_odom_base;
  const std::size_t count = std::min(scan.point_count, RegisteredScan::kMaxPoints);
  one.p_base.reserve(count);
  for (const ScanPoint& p : std::span(scan.points, count)) one.p_base.emplace_back(p.x_m, p.y_m, p.z_m);
}

bool PlaceStage::is_due(std::int64_t stamp_ns) const {
  if (scans_.size() < kScans) return false;
  const double first_s = status_.lost ? kAroundLostS : around_first_ ? kAroundLastS : 0.0;
  if (asked_ns_ == 0) return status_.waited_s >= first_s;
  const Eigen::Isometry3d T = T_odom_asked_.inverse(Eigen::Isometry) * upright(scans_.back().T_odom_base);
  const bool moved =
      T.translation().head<2>().norm() >= kNextViewM || std::abs(yaw_of(T.linear())) >= kNextViewRad;
  const bool waits = status_.state == PlaceState::kAmbiguous || status_.carried;
  return moved || (!waits && seconds_between(asked_ns_, stamp_ns) >= kNextTimeS);
}

bool PlaceStage::is_over() const {
  if (stays_ || status_.lost || status_.carried) return false;
  const bool blind = status_.state == PlaceState::kBlind || status_.state == PlaceState::kCollecting;
  return unknown_ >= kUnknownSearches || status_.driven_m > kLongestWayM ||
         status_.waited_s > kLongestSearchS || (blind && status_.waited_s > kLongestBlindS);
}

void PlaceStage::search(const PoseEstimate& pose) {
  const CpuTimer timer;
  if (!map_) map_ = read_map_(pose.session);
  if (!map_) {
    unknown_ = kUnknownSearches;  // there is no map that could tell
    return;
  }
  const Eigen::Isometry3d T_odom_base = scans_.back().T_odom_base;
  const Eigen::Isometry3d T_odom_level = upright(T_odom_base);
  fill_query(T_odom_level);
  const ColdStartInput input{*map_, query_, T_odom_level.linear().transpose() * T_odom_base.linear(),
                             height()};
  const bool follows = status_.state == PlaceState::kAmbiguous && !status_.carried;
  const Eigen::Isometry3d T_before_now = T_odom_asked_.inverse(Eigen::Isometry) * T_odom_level;
  const ColdStartResult& result =
      follows ? cold_start_.follow(input, T_before_now) : cold_start_.locate(input);
  T_odom_asked_ = T_odom_level;
  asked_ns_ = pose.stamp_ns;
  ++status_.searches;
  status_.fit = result.candidates.empty() ? 0.0 : result.candidates.front().fit.score();
  status_.search_s = 1e-3 * timer.elapsed_ms();
  status_.carried ? take_carried(result, pose) : take(result, pose.stamp_ns);
}

// Scans of a robot that drives are laid onto each other by odometry.
void PlaceStage::fill_query(const Eigen::Isometry3d& T_odom_level) {
  std::vector<Eigen::Vector3f> p_level;
  query_.clear();
  for (const OdometryScan& scan : scans_) {
    const Eigen::Isometry3d T_level_base = T_odom_level.inverse(Eigen::Isometry) * scan.T_odom_base;
    const Eigen::Isometry3f T = T_level_base.cast<float>();
    p_level.clear();
    for (const Eigen::Vector3f& p : scan.p_base) p_level.push_back(T * p);
    query_.add(p_level, (T_level_base * T_base_lidar_.translation()).cast<float>());
  }
  query_.finish();
}

// By air pressure, where the datum of the map holds; else anywhere between its lowest and its highest ground.
SlabHeight PlaceStage::height() {
  const Extent extent = heights_of(map_->structure());
  const bool differential = prior_.height_source == HeightSource::kDifferential;
  const double z_m = height_is_of_map_ ? z_above_height_m_ + prior_.height_m : last_z_m_;
  const bool inside = z_m > extent.low_m - kOutsideMapM && z_m < extent.high_m + kOutsideMapM;
  status_.height_is_known =
      height_is_of_map_ && (status_.lost || status_.carried || (inside && differential));
  if (status_.height_is_known) {
    const double sigma_m = std::sqrt(std::max(prior_.height_variance_m2, 0.0) + squared(kLeastHeightSigmaM));
    return {z_m, std::min(sigma_m, kLargestHeightSigmaM)};
  }
  const double half_m = 0.5 * (extent.high_m - extent.low_m);
  return {extent.low_m + half_m, std::max(half_m / 3.0, std::min(kUnknownHeightM, half_m))};
}

void PlaceStage::take(const ColdStartResult& result, std::int64_t stamp_ns) {
  status_.hypothesis_count = 0;
  const bool fits_badly = result.verdict == ColdStartVerdict::kFound && status_.fit < kLeastFit;
  switch (fits_badly ? ColdStartVerdict::kUnknown : result.verdict) {
    case ColdStartVerdict::kFound: {
      const Eigen::Isometry3d& T_map_level = result.candidates.front().T_map_level;
      tell(T_map_level * T_odom_asked_.inverse(Eigen::Isometry), stamp_ns);
      break;
    }
    case ColdStartVerdict::kAmbiguous:
      unknown_ = 0;
      status_.state = PlaceState::kAmbiguous;
      describe(result);
      break;
    case ColdStartVerdict::kUnknown:
    case ColdStartVerdict::kHintRefused:
      unknown_ += query_.can_judge() ? 1 : 0;
      status_.state = query_.can_judge() ? PlaceState::kUnknown : PlaceState::kBlind;
      break;
  }
}

void PlaceStage::tell(const Eigen::Isometry3d& T_map_odom, std::int64_t stamp_ns) {
  found_ = T_map_odom;
  told_ns_ = stamp_ns;
  ++status_.found;
  status_.state = PlaceState::kTold;
}

void PlaceStage::describe(const ColdStartResult& result) {
  for (const PlaceCandidate& one : result.candidates) {
    if (status_.hypothesis_count == PlaceStatus::kMostHypotheses) break;
    const Eigen::Vector3d p = one.T_map_base.translation();
    status_.hypotheses.at(status_.hypothesis_count++) = {
        {p.x(), p.y(), p.z()}, yaw_of(one.T_map_level.linear()), one.weight};
  }
}

}  // namespace isobar
