// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/errors.hpp"
#include "run/files/stl_file.hpp"
#include "run/recording/recording_writer.hpp"
#include "simulation/atmosphere.hpp"
#include "simulation/barometer_model.hpp"
#include "simulation/imu_model.hpp"
#include "simulation/lidar_model.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/lidar_recording.hpp"
#include "simulation/scenario.hpp"
#include "simulation/scenario_list.hpp"
#include "simulation/session.hpp"
#include "simulation/wheel_model.hpp"

namespace isobar::simulation {

using recording::RecordingWriter;

namespace {

/// Clock of a machine: converts the time of the run to stamps.
struct Clock {
  std::int64_t start_ns = 0;
  double offset_s = 0.0;
  double drift = 0.0;

  [[nodiscard]] std::int64_t stamp_ns(double time_s) const {
    return start_ns + std::llround(1e9 * (offset_s + (1.0 + drift) * time_s));
  }
};

/// Mount of a sensor as it is: differs from the manifest, since sensors are mounted by hand and measured with a
/// ruler, and by the deviation asked for.
Mount true_mount(const Mount& mount, const ScenarioRequest& request, const std::string& sensor,
                 double angle_sigma_deg) {
  Random random(request.seed, sensor + " mount");
  Mount real = mount;
  for (int axis = 0; axis < 3; ++axis) real.rpy_deg[axis] += random.normal(angle_sigma_deg);
  for (int axis = 0; axis < 3; ++axis) real.xyz_m[axis] += random.normal(0.002);
  Random more(request.seed, sensor + " mount deviation");
  for (int axis = 0; axis < 3; ++axis) {
    real.rpy_deg[axis] += more.normal(request.deviations.mount_error_deg);
  }
  return real;
}

Mount true_lidar(const ScenarioRequest& request, const Scenario& scenario) {
  return true_mount(scenario.mounts.lidar, request, "lidar", 0.05);
}

Mount true_imu(const ScenarioRequest& request, const Scenario& scenario) {
  return true_mount(scenario.mounts.imu, request, "imu", 0.1);
}

bool has_wheels(const ScenarioRequest& request, const Scenario& scenario) {
  return scenario.has_wheels && !request.deviations.without_wheels;
}

/// Data common to all sensors of a run.
struct Run {
  Run(const ScenarioRequest& of, const Scenario& in, RecordingWriter& to)
      : request(of),
        scenario(in),
        writer(to),
        lidar(true_lidar(of, in)),
        imu(true_imu(of, in)),
        duration_s(std::min(of.stop_after_s, in.trajectory.duration_s())) {
    Random start(of.session_seed != 0 ? of.session_seed : of.seed, "start");
    robot.start_ns = 1'700'000'000'000'000'000 + std::llround(start.uniform(0.0, 3e7) * 1e9);
  }

  const ScenarioRequest& request;
  const Scenario& scenario;
  RecordingWriter& writer;
  Mount lidar;  ///< true
  Mount imu;    ///< true
  double duration_s;
  Clock robot;

  /// Of this session.
  [[nodiscard]] Random random(std::string_view name) const { return Random(session_seed(), name); }
  /// Of a device, which is the same in all sessions.
  [[nodiscard]] Random random_device(std::string_view name) const { return Random(request.seed, name); }
  [[nodiscard]] std::uint64_t session_seed() const {
    return request.session_seed != 0 ? request.session_seed : request.seed;
  }
  [[nodiscard]] const Deviations& deviations() const { return request.deviations; }
  [[nodiscard]] bool is_recorded(double time_s) const { return time_s >= deviations().start_at_s; }
};

/// Delay of a stamp by the scheduling of the machine that takes it.
double stamp_jitter_s(Random& random) { return std::min(random.exponential(60e-6), 2e-3); }

void write_imu(const Run& run) {
  const bool tracked = run.scenario.has_wheels;
  ImuModel imu(run.scenario.trajectory, run.imu.T_base_sensor(),
               ImuErrors::draw(run.random("imu errors"), tracked), run.random("imu noise"));
  Random jitter = run.random("imu stamps");
  for (double t = 0.0; t <= run.duration_s; t += 1.0 / ImuModel::kRateHz) {
    ImuSample sample = imu.sample(t);
    const double jitter_s = stamp_jitter_s(jitter);
    if (!run.is_recorded(t)) continue;
    sample.stamp_ns = run.robot.stamp_ns(t + jitter_s);
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
    const double jitter_s = stamp_jitter_s(jitter);
    if (!run.is_recorded(t)) continue;
    sample.stamp_ns = run.robot.stamp_ns(t + jitter_s);
    run.writer.add_wheel(sample);
  }
}

/// Whether a base station that sends `rate_hz` of its full rate sends its sample number n.
bool is_sent(std::uint64_t n, double rate_hz) {
  const double share = rate_hz / Deviations::kFullBaseRateHz;
  const auto sent_before = [&](std::uint64_t samples) {
    return std::floor(share * static_cast<double>(samples));
  };
  return sent_before(n + 1) > sent_before(n);
}

void write_robot_pressure(const Run& run, const Atmosphere& air, BarometerModel& model, double time_s,
                          Random& jitter) {
  const BarometerDeviation& deviation = run.deviations().robot;
  const double middle_s = time_s - 0.5 * BarometerModel::kConversionS;
  const MotionState state = run.scenario.trajectory.at(middle_s);
  const double height_m = (state.p_world + state.q_world_base * run.scenario.mounts.pressure_port_m).z();
  PressureSample sample =
      model.sample(time_s, air.robot_pa(middle_s, height_m), run.scenario.air_temperature_c);
  sample.pressure_pa += deviation.drift.at(time_s);
  sample.temperature_c += deviation.thermometer_offset_k;
  sample.stamp_ns = run.robot.stamp_ns(time_s + stamp_jitter_s(jitter));
  if (!run.deviations().without_barometer && run.is_recorded(time_s)) run.writer.add_pressure(sample);
}

void write_base_pressure(const Run& run, const Atmosphere& air, BarometerModel& model, std::uint64_t n,
                         double time_s, const Clock& clock, Random& jitter) {
  const BarometerDeviation& deviation = run.deviations().base;
  PressureSample sample = model.sample(time_s, air.base_pa(time_s - 0.5 * BarometerModel::kConversionS),
                                       run.scenario.air_temperature_c);
  sample.pressure_pa += deviation.drift.at(time_s);
  sample.temperature_c += deviation.thermometer_offset_k;
  sample.stamp_ns = clock.stamp_ns(time_s + stamp_jitter_s(jitter));
  const auto& silent = run.scenario.base_silent;
  if (run.deviations().without_base || !run.is_recorded(time_s) ||
      !is_sent(n, run.deviations().base_rate_hz) ||
      std::any_of(silent.begin(), silent.end(),
                  [&](const TimeSpan& span) { return span.contains(time_s); })) {
    return;
  }
  run.writer.add_base_pressure(sample);
}

void write_pressure(const Run& run) {
  static_assert(Deviations::kFullBaseRateHz == BarometerModel::kRateHz);
  const Atmosphere air(run.scenario, AirErrors::draw(run.random("air errors")), run.random("air"));
  BarometerModel robot(BarometerErrors::draw(run.random_device("barometer errors"), false),
                       run.random("barometer noise"));
  BarometerModel base(BarometerErrors::draw(run.random_device("base errors"), true),
                      run.random("base noise"));
  Random random = run.random("pressure stamps");
  // The base station has its own clock, at best set by NTP: an offset of milliseconds to a second, a drift of
  // tens of ppm.
  Clock base_clock = run.robot;
  base_clock.offset_s = random.sign() * std::pow(10.0, random.uniform(-2.3, 0.0));
  base_clock.drift = random.normal(20e-6);
  const double phase_s = random.uniform(0.0, 1.0 / BarometerModel::kRateHz);
  std::uint64_t n = 0;
  for (double t = 0.01; t <= run.duration_s; t += 1.0 / BarometerModel::kRateHz) {
    write_robot_pressure(run, air, robot, t, random);
    write_base_pressure(run, air, base, n++, t + phase_s, base_clock, random);
  }
}

void write_truth(const Run& run) {
  for (double t = 0.0; t <= run.duration_s; t += 0.01) {
    if (!run.is_recorded(t)) continue;
    const MotionState state = run.scenario.trajectory.at(t);
    Eigen::Isometry3d T_world_base = Eigen::Isometry3d::Identity();
    T_world_base.linear() = state.q_world_base.toRotationMatrix();
    T_world_base.translation() = state.p_world;
    run.writer.add_reference(run.robot.stamp_ns(t), T_world_base);
  }
  for (const LabelledSpan& span : run.scenario.labels) {
    if (span.start_s >= run.duration_s) break;
    const double start_s = std::max(span.start_s, run.deviations().start_at_s);
    const double end_s = std::min(span.end_s, run.duration_s);
    if (start_s > end_s) continue;
    run.writer.add_segment({run.robot.stamp_ns(start_s), run.robot.stamp_ns(end_s), span.label});
  }
}

void write_lidar(const Run& run, const LidarPlan& plan, const std::function<void(double)>& progress) {
  const LidarModel lidar(plan, run.scenario.world, run.scenario.trajectory, run.lidar.T_base_sensor(),
                         LidarErrors::draw(run.random_device("lidar errors"), plan), run.session_seed());
  const LidarSpan span{run.deviations().start_at_s, run.duration_s};
  const auto stamp_ns = [&run](double time_s) { return run.robot.stamp_ns(time_s); };
  write_lidar_packets(plan, lidar, span, stamp_ns, run.writer, progress);
}

/// "lidar rpy_deg [0.1, -0.2, 0.0] xyz_m [0.1, 0, 0.55]"
std::string mount_text(const std::string& sensor, const Mount& mount) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s rpy_deg [%.4f, %.4f, %.4f] xyz_m [%.4f, %.4f, %.4f]",
                sensor.c_str(), mount.rpy_deg.x(), mount.rpy_deg.y(), mount.rpy_deg.z(), mount.xyz_m.x(),
                mount.xyz_m.y(), mount.xyz_m.z());
  return text.data();
}

recording::Manifest make_manifest(const ScenarioRequest& request, const Scenario& scenario) {
  const Deviations& deviations = request.deviations;
  recording::Manifest manifest = recording::Manifest::with_all_sensors();
  manifest.description = request.name + (request.short_form ? " (short)" : "") + ", seed " +
                         std::to_string(request.seed) + ": " + scenario.description;
  if (request.session_seed != 0) manifest.description += "; session " + std::to_string(request.session_seed);
  for (const std::string& option : deviations.options()) manifest.description += "; --" + option;
  manifest.description += "; true mounts: " + mount_text("lidar", true_lidar(request, scenario)) + ", " +
                          mount_text("imu", true_imu(request, scenario));
  describe_lidar(find_lidar_plan(request.lidar), *manifest.lidar);
  manifest.lidar->mount = scenario.mounts.lidar;
  manifest.imu->mount = scenario.mounts.imu;
  manifest.barometer->mount.xyz_m = scenario.mounts.pressure_port_m;
  if (!has_wheels(request, scenario)) manifest.wheel.reset();
  if (deviations.without_imu) manifest.imu.reset();
  if (deviations.without_base) manifest.base_barometer.reset();
  if (deviations.without_barometer) manifest.barometer.reset();
  return manifest;
}

/// Scenario of a request, with the deviations of its air and its base station.
Scenario make_scenario(const ScenarioRequest& request) {
  Scenario scenario = find_scenario(request.name).make(request.seed, request.short_form);
  if (request.session_seed != 0) begin_another_session(scenario, request.session_seed);
  const Deviations& deviations = request.deviations;
  scenario.air.common_ramp = deviations.common_ramp;
  scenario.air.common_gust = deviations.common_gust;
  if (deviations.base_silent) scenario.base_silent.push_back(*deviations.base_silent);
  if (deviations.airflow) scenario.air.port_coefficient = *deviations.airflow;
  if (deviations.zones && scenario.air.zone.empty()) {
    throw UsageError("zones: scenario '" + request.name + "' has no ventilated zones");
  }
  if (deviations.zones) scenario.air.zones = deviations.zones;
  if (deviations.pulses) {
    constexpr double kUsualPulses1S = 1.0 / 60.0;  // of a building
    scenario.air.pulses = deviations.pulses;
    if (scenario.air.door_pulses_1_s == 0.0) scenario.air.door_pulses_1_s = kUsualPulses1S;
  }
  if (deviations.start_at_s >= std::min(request.stop_after_s, scenario.trajectory.duration_s())) {
    throw UsageError("start-at: the run of scenario '" + request.name + "' ends before that");
  }
  return scenario;
}

}  // namespace

std::string recording_name(const ScenarioRequest& request) {
  std::string lidar = request.lidar == kUsualLidar ? "" : "-" + request.lidar;
  std::replace(lidar.begin(), lidar.end(), ' ', '-');
  return request.name + "-" + std::to_string(request.seed) +
         (request.session_seed != 0 ? "-session-" + std::to_string(request.session_seed) : "") +
         (request.short_form ? "-short" : "") + lidar + request.deviations.suffix();
}

void simulate(const ScenarioRequest& request, const std::filesystem::path& out_dir,
              const std::function<void(double)>& progress) {
  const LidarPlan& plan = find_lidar_plan(request.lidar);
  const Scenario scenario = make_scenario(request);
  RecordingWriter writer(out_dir, make_manifest(request, scenario));
  const Run run(request, scenario, writer);
  if (!request.deviations.without_imu) write_imu(run);
  if (has_wheels(request, scenario)) write_wheels(run);
  write_pressure(run);
  write_truth(run);
  files::write_stl(out_dir / files::kSurfacesFile, scenario.world.standing().triangles());
  write_lidar_calibration(plan, out_dir);
  write_lidar(run, plan, progress);
  writer.close();
}

}  // namespace isobar::simulation
