// SPDX-License-Identifier: BSD-3-Clause
// Cost of one map query as in matching, over the size of the map, at random points near its planes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "config/config.hpp"
#include "daemon/stage_settings.hpp"
#include "tests/benchmark/driver/system_under_test.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

constexpr double kMaxDistanceM = 0.35;  // largest search distance of the last iterations
constexpr double kHeightM = 1.0;        // height of the sensor above each floor
constexpr double kFloorStepM = 4.0;
constexpr double kPointStepM = 0.1;
constexpr double kRadiusM = 10.0;  // radius seen by one scan

/// Stacked floors, observed from above at the centres of squares: every point faces its observer.
class Floors {
 public:
  /// Extends the map square by square, from the centre outward, to `planes` planes.
  explicit Floors(std::size_t planes) : system_(settings()), scan_(std::make_unique<RegisteredScan>()) {
    for (int ring = 0; system_.plane_count() < planes; ++ring) {
      for (int x = -ring; x <= ring; ++x) {
        for (int y = -ring; y <= ring; ++y) {
          if (std::max(std::abs(x), std::abs(y)) != ring) continue;
          for (int floor = -3; floor <= 3 && system_.plane_count() < planes; ++floor) see(x, y, floor);
        }
      }
    }
  }

  struct Query {
    Eigen::Vector3d p_map;
    Eigen::Vector3d viewpoint_map;
  };

  [[nodiscard]] std::vector<Query> queries(std::size_t count) const {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::size_t> square(0, seen_.size() - 1);
    std::uniform_real_distribution<double> across(-kRadiusM, kRadiusM);
    std::normal_distribution<double> off(0.0, 0.05);
    std::vector<Query> queries;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& viewpoint = seen_[square(random)];
      const Eigen::Vector3d offset(across(random), across(random), off(random) - kHeightM);
      queries.push_back({viewpoint + offset, viewpoint});
    }
    return queries;
  }

  [[nodiscard]] const bench::SystemUnderTest& system() const { return system_; }

 private:
  static StageSettings settings() {
    StageSettings settings = stage_settings(Config{});
    settings.T_base_lidar = Eigen::Isometry3d::Identity();
    settings.map.radius_m = 200.0;  // the largest: no tile leaves memory
    settings.map.see_through_limit = 0;
    return settings;
  }

  void see(int x, int y, int floor) {
    seen_.emplace_back(2.0 * kRadiusM * x, 2.0 * kRadiusM * y, kFloorStepM * floor);
    scan_->pose = PoseEstimate{};
    scan_->pose.mode = PoseMode::kRegistered;
    scan_->pose.T_map_base.translation() = seen_.back();
    // Two scans, slightly displaced, give each cell enough points for a plane.
    for (const double shift : {0.0, kPointStepM / 2.0}) {
      scan_->pose.stamp_ns = (stamp_ns_ += 2'000'000'000);
      scan_->point_count = 0;
      for (double px = -kRadiusM + shift; px < kRadiusM; px += kPointStepM) {
        for (double py = -kRadiusM + shift; py < kRadiusM; py += kPointStepM) {
          scan_->points[scan_->point_count++] = {
              static_cast<float>(px), static_cast<float>(py), static_cast<float>(-kHeightM), 0, 0, 0};
        }
      }
      if (system_.update_map(*scan_)) system_.hand_over();
    }
  }

  bench::SystemUnderTest system_;
  std::unique_ptr<RegisteredScan> scan_;
  std::vector<Eigen::Vector3d> seen_;
  std::int64_t stamp_ns_ = 0;
};

void nearest(benchmark::State& state) {
  const Floors floors(static_cast<std::size_t>(state.range(0)));
  const std::vector<Floors::Query> queries = floors.queries(1 << 16);
  std::size_t i = 0;
  std::size_t hits = 0;
  for (auto _ : state) {
    const Floors::Query& query = queries[i++ % queries.size()];
    hits += floors.system().has_plane_near(query.p_map, query.viewpoint_map, kMaxDistanceM) ? 1 : 0;
  }
  state.counters["planes"] = static_cast<double>(floors.system().plane_count());
  state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(state.iterations());
}

BENCHMARK(nearest)->Arg(1'000)->Arg(10'000)->Arg(100'000)->Arg(1'000'000);

}  // namespace
