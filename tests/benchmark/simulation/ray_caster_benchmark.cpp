// SPDX-License-Identifier: BSD-3-Clause
// Rays per second on one core: ray casting alone in the scenarios' worlds, and complete packets.
#include <benchmark/benchmark.h>

#include <cmath>

#include "simulation/lidar_model.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/scenario.hpp"

namespace {

using namespace isobar::simulation;

void packets(benchmark::State& state, Scenario (*make)(std::uint64_t, bool)) {
  const Scenario scenario = make(1, false);
  const LidarPlan& plan = find_lidar_plan("VLP-16");
  const LidarModel lidar(plan, scenario.world, scenario.trajectory, scenario.mounts.lidar.T_base_sensor(),
                         LidarErrors::draw(Random(1), plan), 1);
  const auto count = static_cast<std::uint64_t>(scenario.trajectory.duration_s() / lidar.packet_time_s(1));
  std::uint64_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(lidar.packet(n));
    n = (n + 997) % count;  // spread over the run
  }
  state.counters["rays"] =
      benchmark::Counter(384.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void rays(benchmark::State& state, Scenario (*make)(std::uint64_t, bool)) {
  const Scenario scenario = make(1, false);
  World::Moment moment;
  Random random(2);
  std::int64_t cast = 0;
  for (auto _ : state) {
    const double time_s = random.uniform(0.0, scenario.trajectory.duration_s());
    const Eigen::Vector3d eye = scenario.trajectory.at(time_s).p_world + Eigen::Vector3d(0.0, 0.0, 0.5);
    scenario.world.look(time_s, eye, 100.0, moment);
    for (int i = 0; i < 1000; ++i, ++cast) {
      const double azimuth = random.uniform(0.0, 6.283185);
      const double elevation = random.uniform(-0.26, 0.26);
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      benchmark::DoNotOptimize(scenario.world.cast(moment, eye, direction, 100.0));
    }
  }
  state.counters["rays"] = benchmark::Counter(static_cast<double>(cast), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(rays, three_floors, make_three_floors);
BENCHMARK_CAPTURE(rays, moulin, make_moulin);
BENCHMARK_CAPTURE(rays, city, make_city);
BENCHMARK_CAPTURE(rays, city_10km, make_city_10km);
BENCHMARK_CAPTURE(packets, three_floors, make_three_floors);
BENCHMARK_CAPTURE(packets, elevator, make_elevator);
BENCHMARK_CAPTURE(packets, moulin, make_moulin);
BENCHMARK_CAPTURE(packets, city, make_city);

}  // namespace

BENCHMARK_MAIN();
