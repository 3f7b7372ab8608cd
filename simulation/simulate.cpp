// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "run/recording/recording_writer.hpp"
#include "simulation/atmosphere.hpp"
#include "simulation/barometer_model.hpp"
#include "simulation/imu_model.hpp"
#include "simulation/lidar_model.hpp"
#include "simulation/scenario.hpp"
#include "simulation/wheel_model.hpp"

namespace isobar::simulation {

using recording::RecordingWriter;

namespace {

struct Entry {
  const char* name;
  const char* description;
  Scenario (*make)(std::uint64_t seed, bool short_form);
};

constexpr std::array kEntries{
    Entry{"three-floors", "tracked robot, 100 m of corridors on each of three floors, two staircases",
          make_three_floors},
    Entry{"elevator", "tracked robot, third floor, elevator to the ground floor, a ramp and back",
          make_elevator},
    Entry{"moulin", "hanging sphere, lowered into a shaft of ice and pulled up again", make_moulin},
    Entry{"stairs-demo", "tracked robot, a corridor, down a staircase to the next floor and on",
          make_stairs_demo},
    Entry{"city", "wheeled robot, 2 km of hilly streets with traffic at 6 to 10 m/s", make_city},
    Entry{"city-10km", "the same over 10 km, nearly all of it through streets never seen before",
          make_city_10km},
    Entry{"city-hour", "the same for an hour, 20 km: for runs in real time", make_city_hour},
};

const Entry& find_entry(const std::string& name) {
  const auto* found =
      std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& entry) { return name == entry.name; });
  if (found != kEntries.end()) return *found;
  std::string names;
  for (const Entry& entry : kEntries) names += (names.empty() ? "" : ", ") + std::string(entry.name);
  throw UsageError("unknown scenario '" + name + "'; known scenarios: " + names);
}

/// Clock of a machine: converts the time of the run to stamps.
struct Clock {
  std::int64_t start_ns = 0;
  double offset_s = 0.0;
  double drift = 0.0;

  [[nodiscard]] std::int64_t stamp_ns(double time_s) const {
    return start_ns + std::llround(1e9 * (offset_s + (1.0 + drift) * time_s));
  }
};

/// Data common to all sensors of a run.
struct Run {
  const Scenario& scenario;
  std::uint64_t seed;
  Clock robot;
  RecordingWriter& writer;

  double duration_s;
  [[nodiscard]] Random random(std::string_view name) const { return Random(seed, name); }
};

/// Delay of a stamp by the scheduling of the machine that takes it.
double stamp_jitter_s(Random& random) { return std::min(random.exponential(60e-6), 2e-3); }

/// True mount of a sensor: differs from the manifest, since sensors are mounted by hand and measured with a
/// ruler.
Eigen::Isometry3d true_mount(const Mount& mount, Random random, double angle_sigma_deg) {
  Mount real = mount;
  for (int axis = 0; axis < 3; ++axis) real.rpy_deg[axis] += random.normal(angle_sigma_deg);
  for (int axis = 0; axis < 3; ++axis) real.xyz_m[axis] += random.normal(0.002);
  return real.T_base_sensor();
}

void write_imu(const Run& run) {
  const bool tracked = run.scenario.has_wheels;
  ImuModel imu(run.scenario.trajectory, true_mount(run.scenario.mounts.imu, run.random("imu mount"), 0.1),
               ImuErrors::draw(run.random("imu errors"), tracked), run.random("imu noise"));
  Random jitter = run.random("imu stamps");
  for (double t = 0.0; t <= run.duration_s; t += 1.0 / ImuModel::kRateHz) {
    ImuSample sample = imu.sample(t);
    sample.stamp_ns = run.robot.stamp_ns(t + stamp_jitter_s(jitter));
    run.writer.add_imu(sample);
  }
}

void write_wheels(const Run& run) {
  WheelModel wheels(run.scenario.trajectory,
                    WheelErrors::draw(run.random("wheel errors"), run.scenario.tracked),
                    run.random("wheel noise"));
  Random jitter = run.random("wheel stamps");
  for (double t = 0.003; t <= run.duration_s; t += 1.0 / WheelModel::kRateHz) {
    WheelSample sample = wheels.sample(t);
    sample.stamp_ns = run.robot.stamp_ns(t + stamp_jitter_s(jitter));
    run.writer.add_wheel(sample);
  }
}

void write_pressure(const Run& run) {
  const Scenario& scenario = run.scenario;
  const Atmosphere air(scenario, AirErrors::draw(run.random("air errors")), run.random("air"));
  BarometerModel robot(BarometerErrors::draw(run.random("barometer errors"), false),
                       run.random("barometer noise"));
  BarometerModel base(BarometerErrors::draw(run.random("base errors"), true), run.random("base noise"));
  Random random = run.random("pressure stamps");
  // The base station has its own clock, at best set by NTP: an offset of milliseconds to a second, a drift of
  // tens of ppm.
  Clock base_clock = run.robot;
  base_clock.offset_s = random.sign() * std::pow(10.0, random.uniform(-2.3, 0.0));
  base_clock.drift = random.normal(20e-6);
  const double phase_s = random.uniform(0.0, 1.0 / BarometerModel::kRateHz);
  for (double t = 0.01; t <= run.duration_s; t += 1.0 / BarometerModel::kRateHz) {
    const double middle_s = t - 0.5 * BarometerModel::kConversionS;
    const MotionState state = scenario.trajectory.at(middle_s);
    const double height_m = (state.p_world + state.q_world_base * scenario.mounts.pressure_port_m).z();
    PressureSample sample = robot.sample(t, air.robot_pa(middle_s, height_m), scenario.air_temperature_c);
    sample.stamp_ns = run.robot.stamp_ns(t + stamp_jitter_s(random));
    run.writer.add_pressure(sample);
    const double base_s = t + phase_s;
    sample = base.sample(base_s, air.base_pa(base_s - 0.5 * BarometerModel::kConversionS),
                         scenario.air_temperature_c);
    sample.stamp_ns = base_clock.stamp_ns(base_s + stamp_jitter_s(random));
    run.writer.add_base_pressure(sample);
  }
}

void write_truth(const Run& run) {
  for (double t = 0.0; t <= run.duration_s; t += 0.01) {
    const MotionState state = run.scenario.trajectory.at(t);
    Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
    T_world_base.linear() = state.q_world_base.toRotationMatrix();
    T_world_base.translation() = state.p_world;
    run.writer.add_reference(run.robot.stamp_ns(t), T_world_base);
  }
  for (const LabelledSpan& span : run.scenario.labels) {
    if (span.start_s >= run.duration_s) break;
    const double end_s = std::min(span.end_s, run.duration_s);
    run.writer.add_segment({run.robot.stamp_ns(span.start_s), run.robot.stamp_ns(end_s), span.label});
  }
}

/// Packets in batches, each split among all cores; a packet depends on its number alone.
void write_lidar(const Run& run, const std::function<void(double)>& progress) {
  const LidarModel lidar(run.scenario.world, run.scenario.trajectory,
                         true_mount(run.scenario.mounts.lidar, run.random("lidar mount"), 0.05),
                         LidarErrors::draw(run.random("lidar errors")), run.seed);
  const auto total = static_cast<std::uint64_t>(run.duration_s / LidarModel::packet_time_s(1));
  const std::uint64_t workers = std::clamp(std::thread::hardware_concurrency(), 1U, 16U);
  constexpr std::uint64_t kBatch = 512;
  std::vector<ReceivedPacket> batch(kBatch);
  for (std::uint64_t first = 0; first < total; first += kBatch) {
    const std::uint64_t count = std::min(kBatch, total - first);
    const auto work = [&](std::uint64_t worker) {
      for (std::uint64_t i = worker; i < count; i += workers) batch[i] = lidar.packet(first + i);
    };
    {
      std::vector<std::jthread> helpers;
      for (std::uint64_t worker = 1; worker < workers; ++worker) helpers.emplace_back(work, worker);
      work(0);
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      run.writer.add_packet(run.robot.stamp_ns(batch[i].receive_time_s), batch[i].bytes);
    }
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(total));
  }
}

recording::Manifest make_manifest(const ScenarioRequest& request, const Scenario& scenario) {
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  manifest.description = request.name + (request.short_form ? " (short)" : "") + ", seed " +
                         std::to_string(request.seed) + ": " + scenario.description;
  manifest.lidar->mount = scenario.mounts.lidar;
  manifest.imu->mount = scenario.mounts.imu;
  manifest.barometer->mount.xyz_m = scenario.mounts.pressure_port_m;
  if (!scenario.has_wheels) manifest.wheel.reset();
  return manifest;
}

}  // namespace

std::vector<ScenarioInfo> scenarios() {
  std::vector<ScenarioInfo> infos;
  infos.reserve(kEntries.size());
  for (const Entry& entry : kEntries) infos.push_back({entry.name, entry.description});
  return infos;
}

void simulate(const ScenarioRequest& request, const std::filesystem::path& out_dir,
              const std::function<void(double)>& progress) {
  const Scenario scenario = find_entry(request.name).make(request.seed, request.short_form);
  RecordingWriter writer(out_dir, make_manifest(request, scenario));
  Random random(request.seed, "start");
  Run run{
      scenario, request.seed, {}, writer, std::min(request.stop_after_s, scenario.trajectory.duration_s())};
  run.robot.start_ns = 1'700'000'000'000'000'000 + std::llround(random.uniform(0.0, 3e7) * 1e9);
  write_imu(run);
  if (scenario.has_wheels) write_wheels(run);
  write_pressure(run);
  write_truth(run);
  write_lidar(run, progress);
  writer.close();
}

}  // namespace isobar::simulation
