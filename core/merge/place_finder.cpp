// SPDX-License-Identifier: BSD-3-Clause
#include "core/merge/place_finder.hpp"

#include "core/so3.hpp"

namespace isobar {
namespace {

// Key scans that a query has besides its own: one of so many.
constexpr std::size_t kOthersEvery = 3;
// And those nearer than this [m]: farther ones have seen another place.
constexpr double kBesideM = 5.0;

}  // namespace

PlaceFinder::PlaceFinder(const KnownMap& a, const RegistrationConfig& registration,
                         const Eigen::Isometry3d& T_base_lidar_b, BuildingStorage& scans_b)
    : a_(a),
      T_base_lidar_(T_base_lidar_b),
      scans_(scans_b),
      cold_start_({}, registration),
      scan_(std::make_unique<RegisteredScan>()) {}

std::vector<PlaceFinder::KeyPlace> PlaceFinder::places_of(const Building& b) {
  std::vector<KeyPlace> all;
  double way_m = -kOnePlaceM;
  for (const Submap& submap : b.submaps()) {
    for (std::size_t key = 0; key < submap.keys.size(); ++key) {
      if (submap.keys[key].way_m - way_m < kOnePlaceM) continue;
      way_m = submap.keys[key].way_m;
      all.push_back({submap.number, key});
    }
  }
  if (all.size() <= kMostPlaces) return all;
  std::vector<KeyPlace> some;
  for (std::size_t i = 0; i < kMostPlaces; ++i) some.push_back(all[i * all.size() / kMostPlaces]);
  return some;
}

PlaceVote PlaceFinder::look(const Building& b, const KeyPlace& at, const HeightRelation& height) {
  const Submap& submap = b.submaps()[at.submap];
  const Eigen::Isometry3d& T_submap_base = submap.keys[at.key].T_submap_base;
  const Eigen::Isometry3d T_submap_level = upright(T_submap_base);
  const Eigen::Isometry3d T_b_level = b.T_map_submap(at.submap) * T_submap_level;
  PlaceVote vote;
  vote.p_b = T_b_level.translation();
  add_scans(submap, at.key, T_submap_level.inverse());
  if (!query_.can_judge()) return vote;
  const SlabHeight slab{vote.p_b.z() + height.z_a_b_m, height.sigma_m};
  const Eigen::Matrix3d R_level_base = T_submap_level.linear().transpose() * T_submap_base.linear();
  const ColdStartResult& result = cold_start_.locate({a_, query_, R_level_base, slab});
  for (const PlaceCandidate& candidate : result.candidates) {
    vote.hypotheses.push_back({candidate.T_map_level * T_b_level.inverse(), candidate.weight});
  }
  return vote;
}

// The rays of the middle one count, from where its lidar was: of the others only the points.
void PlaceFinder::add_scans(const Submap& submap, std::size_t middle,
                            const Eigen::Isometry3d& T_level_submap) {
  query_.clear();
  const Eigen::Vector3d p_middle = submap.keys[middle].T_submap_base.translation();
  for (std::size_t i = middle % kOthersEvery; i < submap.keys.size(); i += kOthersEvery) {
    const KeyScan& key = submap.keys[i];
    if (i == middle || (key.T_submap_base.translation() - p_middle).norm() > kBesideM) continue;
    static_cast<void>(add_scan(key, T_level_submap, false));
  }
  if (!add_scan(submap.keys[middle], T_level_submap, true)) query_.clear();
  query_.finish();
}

bool PlaceFinder::add_scan(const KeyScan& key, const Eigen::Isometry3d& T_level_submap, bool has_rays) {
  if (key.scan == kNoScanHandle || !scans_.read_scan(key.scan, *scan_)) return false;
  const Eigen::Isometry3f T_level_base = (T_level_submap * key.T_submap_base).cast<float>();
  p_level_.clear();
  for (std::uint32_t i = 0; i < scan_->point_count; ++i) {
    const ScanPoint& point = scan_->points[i];
    p_level_.push_back(T_level_base * Eigen::Vector3f(point.x_m, point.y_m, point.z_m));
  }
  query_.add(p_level_, T_level_base * T_base_lidar_.translation().cast<float>(), has_rays);
  return true;
}

}  // namespace isobar
