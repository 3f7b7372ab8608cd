// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/geometry.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/velodyne/decoder.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/route.hpp"

namespace isobar::test::test_lidar_model {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

// A closed room for which the distance to the walls is known in closed form.
const Vector3d kLow(-3.0, -4.0, 0.0);
const Vector3d kHigh(9.0, 6.0, 3.2);

double distance_to_walls(const Vector3d& p) {
  return std::min((p - kLow).cwiseAbs().minCoeff(), (kHigh - p).cwiseAbs().minCoeff());
}

World make_room() {
  Mesh mesh;
  mesh.box(kLow, kHigh, Surface::kPlaster);
  return World(mesh, {});
}

Trajectory make_drive() {
  Route route({0.0, 0.0}, 0.0, 0.0);
  route.drive({{{4.0, 0.0}, 0.0, 1.0, "flat"}});
  route.turn(3.0);
  std::vector<RawPose> raw = route.samples();
  add_shaking(raw, route.labels(), Random(11));
  return Trajectory(raw);
}

const Mount kMount{{0.2, 0.1, 0.5}, {3.0, -4.0, 25.0}};

/// Distances from the nearest wall of all points of all packets up to `seconds`. `pose_time_of`: time of the
/// pose that a point is transformed with.
template <typename PoseTime>
std::vector<double> wall_errors(const LidarErrors& errors, double seconds, PoseTime pose_time_of) {
  const World room = make_room();
  const Trajectory drive = make_drive();
  const LidarModel lidar(find_lidar_plan("VLP-16"), room, drive, kMount.T_base_sensor(), errors, 1);
  const auto decoder = std::make_unique<ScanAssembler>(std::make_unique<velodyne::Decoder>(velodyne::kVlp16));
  const auto scan = std::make_unique<Scan>();
  std::vector<double> result;
  const auto measure = [&] {
    for (std::uint32_t i = 0; i < scan->point_count; ++i) {
      const ScanPoint& point = scan->points[i];
      const double time_s = 1e-9 * static_cast<double>(scan->stamp_ns + point.time_4us * kPointTimeUnitNs);
      const MotionState state = drive.at(pose_time_of(time_s));
      const Vector3d p_base = kMount.T_base_sensor() * Vector3d(point.x_m, point.y_m, point.z_m);
      result.push_back(distance_to_walls(state.p_world + state.q_world_base * p_base));
    }
  };
  for (std::uint64_t n = 0; lidar.packet_time_s(n) < seconds; ++n) {
    const ReceivedPacket packet = lidar.packet(n);
    const auto stamp_ns = static_cast<std::int64_t>(1e9 * packet.receive_time_s);
    if (decoder->add_packet(packet.bytes, stamp_ns, *scan).scan_complete) measure();
  }
  CHECK(decoder->counters().garbage == 0);
  CHECK(decoder->counters().lost == 0);
  return result;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

TEST_CASE("decoded packets of a perfect sensor on a moving robot are points on the walls of the room") {
  const std::vector<double> errors = wall_errors(LidarErrors{}, 2.0, [](double t) { return t; });
  CHECK(errors.size() > 500'000);  // 300000 per second, all of which hit
  // Resolution of the range (2 mm): 1 mm; of the azimuth (0.01 degree) at 12 m: up to 2 mm; single precision:
  // some micrometres; error of the time anchor (0.1 ms) at 1 m/s: 0.1 mm.
  CHECK(*std::max_element(errors.begin(), errors.end()) < 4e-3);
  CHECK(median(errors) < 1e-3);
}

TEST_CASE("each laser fires from its own pose: with one pose per revolution the walls are smeared") {
  const std::vector<double> errors =
      wall_errors(LidarErrors{}, 2.0, [](double t) { return 0.1 * std::floor(10.0 * t); });
  // Poses are off by up to 0.1 s at 1 m/s.
  CHECK(*std::max_element(errors.begin(), errors.end()) > 0.05);
}

TEST_CASE("at normal incidence, range noise has its nominal standard deviation") {
  LidarErrors errors;
  errors.range_sigma_m = 0.012;
  const std::vector<double> distances = wall_errors(errors, 0.5, [](double t) { return t; });
  // The distance from an oblique wall shows only a part of the error along the beam; at normal incidence the
  // median of |error| is 0.67 sigma = 8 mm.
  CHECK(median(distances) > 0.004);
  CHECK(median(distances) < 0.009);
}

TEST_CASE("the sensor's clock starts at its offset, drifts and wraps every hour") {
  LidarErrors errors;
  errors.clock_offset_s = 3599.9995;
  errors.clock_drift = 1e-3;
  const World room = make_room();
  const Trajectory drive = make_drive();
  const LidarModel lidar(find_lidar_plan("VLP-16"), room, drive, kMount.T_base_sensor(), errors, 1);
  const auto clock_us = [&](std::uint64_t n) {
    const PacketBytes bytes = lidar.packet(n).bytes;
    return static_cast<double>(bytes[1200] | bytes[1201] << 8 | bytes[1202] << 16) + 16777216.0 * bytes[1203];
  };
  CHECK(std::abs(clock_us(0) - 3'599'999'500.0) <= 1.0);
  // 24 firing cycles of 55.296 us, times 1.001, minus the rest of the hour
  CHECK(std::abs(clock_us(1) - (24 * 55.296 * 1.001 - 500.0)) <= 1.0);
}

TEST_CASE("a moving body is hit at its position at the time of the ray") {
  Mesh panel;
  panel.quad({0.0, -1.0, -1.0}, {0.0, 1.0, -1.0}, {0.0, 1.0, 1.0}, {0.0, -1.0, 1.0}, Surface::kWood);
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(2.0 + 0.05 * i);  // 1 m/s
  const std::vector<double> zero(100, 0.0);
  std::vector<MovingBody> bodies;
  bodies.push_back({RayCaster(panel), Channel(x), Channel(zero), Channel(zero)});
  const World world(Mesh{}, std::move(bodies));
  World::Moment moment;
  for (const double t : {1.0, 1.37, 2.9}) {
    world.look(t, Vector3d::Zero(), 50.0, moment);
    const Hit hit = world.cast(moment, Vector3d::Zero(), Vector3d::UnitX(), 50.0);
    CHECK(hit.found);
    CHECK(hit.distance_m == doctest::Approx(2.0 + t));
    CHECK_FALSE(world.cast(moment, Vector3d::Zero(), Vector3d::UnitZ(), 50.0).found);
  }
}

}  // namespace isobar::test::test_lidar_model
