// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/system_under_test.hpp"

#include <algorithm>

#include "daemon/cpu_time.hpp"
#include "tests/core/map/nearest_match.hpp"

namespace isobar::bench {

SystemUnderTest::SystemUnderTest(const StageSettings& settings)
    : registration_(settings.registration, settings.method, settings.T_base_lidar),
      map_(settings.map, settings.T_base_lidar),
      snapshots_(map_.snapshot()) {}

void SystemUnderTest::register_scan(const Scan& scan, RegisteredScan& out) {
  const auto snapshot = snapshots_.pin();
  registration_.register_scan(scan, *snapshot, out);
}

bool SystemUnderTest::update_map(const RegisteredScan& scan) { return map_.update(scan); }

void SystemUnderTest::hand_over() {
  snapshots_.publish(map_.snapshot());
  const auto pinned = snapshots_.pin();
}

bool SystemUnderTest::has_plane_near(const Eigen::Vector3d& p_map, const Eigen::Vector3d& viewpoint_map,
                                     double max_distance_m) const {
  return test::nearest_match(*map_.snapshot(), p_map, viewpoint_map, max_distance_m).has_value();
}

StageProbe::StageProbe(const StageSettings& settings)
    : config_(settings.registration),
      p_base_lidar_(settings.T_base_lidar.translation()),
      deskewer_(settings.T_base_lidar, config_.min_range_m, config_.max_range_m),
      sampler_(config_.map_voxel_m, config_.sample_points),
      correspondences_(config_.sample_points),
      scratch_(std::make_unique<RegisteredScan>()) {}

std::span<const ScanPoint> StageProbe::deskew(const Scan& scan, Prior& end) {
  ScanMotion motion;
  if (!history_.at(scan.end_stamp_ns, motion.end)) motion.end = history_.newest();
  motion.from_wheels = motion.end.velocity_valid;
  deskewer_.start(scan, history_, motion);
  const std::uint32_t count = std::min(scan.point_count, Scan::kMaxPoints);
  scratch_->point_count = static_cast<std::uint32_t>(deskewer_.move({scan.points, count}, scratch_->points));
  end = motion.end;
  return {scratch_->points, scratch_->point_count};
}

StageCosts StageProbe::split(const Scan& scan, const MapSnapshot& map, const RegisteredScan& registered,
                             double registration_ms) {
  StageCosts costs;
  Prior end;
  const CpuTimer deskewing;
  deskew(scan, end);
  costs.deskew_ms = deskewing.elapsed_ms();
  const CpuTimer sampling;
  const std::span<const ScanPoint> deskewed(scratch_->points, scratch_->point_count);
  sampler_.start(*scratch_);
  sampler_.add(deskewed, *scratch_);
  sampler_.finish(*scratch_);
  costs.sample_ms = sampling.elapsed_ms();

  const double match_ms = time_match(map, registered.pose);
  const double solve_ms = time_solve(registered.pose);
  const double rest_ms = std::max(0.0, registration_ms - costs.deskew_ms - costs.sample_ms);
  costs.match_ms = rest_ms * match_ms / (match_ms + solve_ms);
  costs.solve_ms = rest_ms - costs.match_ms;
  return costs;
}

double StageProbe::time_match(const MapSnapshot& map, const PoseEstimate& pose) {
  const CpuTimer timer;
  correspondences_.start(map, pose.T_map_base.translation());
  pairs_ = correspondences_.find(map, sampler_.sample(), 1, pose.T_map_base, p_base_lidar_,
                                 config_.last_distance_m);
  return timer.elapsed_ms();
}

double StageProbe::time_solve(const PoseEstimate& pose) const {
  // An arbitrary prior: the cost of a step does not depend on it.
  PriorTerm prior;
  prior.information = Matrix6d::Identity() * 1e4;
  const MethodTraits traits = traits_of(pose.effective_method, pose.height_source);
  PairNoise noise;
  noise.noise_m = static_cast<float>(config_.min_residual_scale_m);
  const CpuTimer timer;
  const float scale_m = residual_scale_m(pairs_, noise, static_cast<float>(config_.last_distance_m) / 2.0F);
  const NormalEquations equations = accumulate(pairs_, noise, scale_m);
  [[maybe_unused]] volatile bool solved = solve_step(equations, prior, traits.basis, SolverWeights{}).solved;
  return timer.elapsed_ms();
}

}  // namespace isobar::bench
