// SPDX-License-Identifier: BSD-3-Clause
// Every simulated lidar against the project's decoder of its model, in a room whose walls are known in closed form.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/geometry.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "simulation/lidar_model.hpp"
#include "simulation/lidar_plan.hpp"
#include "simulation/lidar_recording.hpp"
#include "simulation/route.hpp"

namespace isobar::test::test_simulated_lidars {

using namespace isobar::simulation;
using Eigen::Vector3d;

namespace {

const Vector3d kLowCorner(-3.0, -4.0, 0.0);
const Vector3d kHighCorner(9.0, 6.0, 3.2);
const Mount kOnRobot{{0.2, 0.1, 0.5}, {3.0, -4.0, 25.0}};
constexpr double kDegree = std::numbers::pi / 180.0;

double wall_distance(const Vector3d& p) {
  return std::min((p - kLowCorner).cwiseAbs().minCoeff(), (kHighCorner - p).cwiseAbs().minCoeff());
}

World box_room() {
  Mesh mesh;
  mesh.box(kLowCorner, kHighCorner, Surface::kPlaster);
  return World(mesh, {});
}

Trajectory standing() {
  Route route({0.0, 0.0}, 0.0, 0.0);
  route.wait(3.0);
  return Trajectory(route.samples());
}

/// From 0.4 s on at up to 1 m/s and 0.6 rad/s, with the vibrations of tracks.
Trajectory driving() {
  Route route({0.0, 0.0}, 0.0, 0.0);
  route.turn(0.7);
  route.drive({{{3.0, 2.5}, 0.0, 1.0, "flat"}});
  std::vector<RawPose> raw = route.samples();
  add_shaking(raw, route.labels(), Random(11));
  return Trajectory(raw);
}

std::unique_ptr<ScanAssembler> assembler_of(const LidarPlan& plan) {
  recording::LidarEntry entry;
  describe_lidar(plan, entry);
  const auto folder =
      std::filesystem::temp_directory_path() / ("isobar-simulated-lidars-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  write_lidar_calibration(plan, folder);
  LidarConfig config;
  config.model = entry.model;
  if (!entry.calibration_file.empty()) config.calibration_file = folder / entry.calibration_file;
  auto assembler = std::make_unique<ScanAssembler>(make_lidar_decoder(config));
  std::filesystem::remove_all(folder);
  if (plan.info_port != 0) {
    const auto unused = std::make_unique<Scan>();
    CHECK(assembler->add_packet(encode_angles(plan), 0, *unused).status == DecodeStatus::kNoPoints);
  }
  return assembler;
}

/// A decoded point and the time at which it was measured, since the start of the run [s].
using TakePoint = std::function<void(const ScanPoint& point, double time_s)>;

/// Simulates and decodes; every packet must be taken. The host's clock shows the arrival of the last firing where
/// the assembler's clock anchor takes it for the first one: scans are late by the duration of a packet.
void decode(const LidarPlan& plan, const Trajectory& trajectory, const LidarErrors& errors, double seconds,
            const TakePoint& take) {
  const World room = box_room();
  const simulation::LidarModel lidar(plan, room, trajectory, kOnRobot.T_base_sensor(), errors, 1);
  const auto assembler = assembler_of(plan);
  const auto scan = std::make_unique<Scan>();
  const auto take_all = [&] {
    for (std::uint32_t i = 0; i < scan->point_count; ++i) {
      const ScanPoint& point = scan->points[i];
      const std::int64_t host_ns = scan->stamp_ns + point.time_4us * kPointTimeUnitNs;
      take(point, 1e-9 * static_cast<double>(host_ns) - lidar.packet_time_s(1) - errors.latency_s);
    }
  };
  std::uint64_t packets = 0;
  for (; lidar.packet_time_s(packets) < seconds; ++packets) {
    const ReceivedPacket packet = lidar.packet(packets);
    const auto stamp_ns = static_cast<std::int64_t>(1e9 * packet.receive_time_s);
    if (assembler->add_packet(packet.bytes, stamp_ns, *scan).scan_complete) take_all();
  }
  if (assembler->flush(*scan)) take_all();
  const LidarCounters& counters = assembler->counters();
  CHECK(counters.packets == packets);
  CHECK(counters.lost + counters.reordered + counters.clock_steps == 0);
}

/// Ring of the laser: its rank by elevation; Livox has no rings.
int ring_of(const LidarPlan& plan, std::size_t laser) {
  if (plan.sweep == LidarSweep::kRosette) return 0;
  int below = 0;
  for (std::size_t i = 0; i < plan.lasers; ++i) {
    below += plan.elevation_deg[i] < plan.elevation_deg[laser] ? 1 : 0;
  }
  return below;
}

/// From the room's wall along a ray from inside, in closed form.
double ray_length(const Vector3d& start, const Vector3d& direction) {
  double length = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double wall = direction[axis] > 0.0 ? kHighCorner[axis] : kLowCorner[axis];
    if (direction[axis] != 0.0) length = std::min(length, (wall - start[axis]) / direction[axis]);
  }
  return length;
}

}  // namespace

TEST_CASE("Every model that has a decoder can be simulated, with its ports") {
  std::vector<std::string> names;
  for (const LidarPlan& plan : lidar_plans()) {
    names.emplace_back(plan.name);
    const auto* model = find_lidar_model(plan.name);
    REQUIRE(model != nullptr);
    CHECK(model->port == plan.port);
    if (plan.info_port != 0) CHECK(model->info_port == plan.info_port);
  }
  CHECK(names == lidar_model_names());
}

TEST_CASE(
    "Of a standing robot each laser's point is where its ray meets the wall, with the laser's ring and "
    "time") {
  for (const LidarPlan& plan : lidar_plans()) {
    if (plan.sweep == LidarSweep::kRosette) continue;  // its directions are in the points alone: next test
    CAPTURE(plan.name);
    std::vector<std::size_t> laser_of_ring(plan.lasers);
    for (std::size_t i = 0; i < plan.lasers; ++i)
      laser_of_ring[static_cast<std::size_t>(ring_of(plan, i))] = i;
    const Eigen::Isometry3d T_room_lidar = kOnRobot.T_base_sensor();
    std::size_t points = 0;
    double worst_m = 0.0;
    double first_deg = INFINITY;
    double last_deg = -INFINITY;
    decode(plan, standing(), LidarErrors{}, 0.25, [&](const ScanPoint& point, double time_s) {
      const std::size_t laser = laser_of_ring.at(point.ring);
      const Vector3d p(point.x_m, point.y_m, point.z_m);
      // Azimuth of the rotor by the point's place, from a beam that starts on the circle of origins.
      const double elevation = plan.elevation_deg[laser] * kDegree;
      const double ahead = plan.azimuth_ahead_deg[laser] * kDegree;
      const double aside_m =
          plan.origin_radius_m * std::sin(ahead);  // the beam passes the axis at that distance
      const double turned = std::asin(aside_m / std::hypot(p.x(), p.y()));
      const double rotor = -std::atan2(p.y(), p.x()) - ahead + turned - plan.zero_deg * kDegree;
      const double beam = rotor + ahead + plan.zero_deg * kDegree;
      const double start = rotor + plan.zero_deg * kDegree;
      const Vector3d origin(plan.origin_radius_m * std::cos(start), -plan.origin_radius_m * std::sin(start),
                            plan.origin_height_m);
      const Vector3d direction(std::cos(elevation) * std::cos(beam), -std::cos(elevation) * std::sin(beam),
                               std::sin(elevation));
      const double range_m = ray_length(T_room_lidar * origin, T_room_lidar.linear() * direction);
      worst_m = std::max(worst_m, (p - origin - range_m * direction).norm());
      const double late_deg = std::remainder(rotor / kDegree - 3'600.0 * time_s, 360.0);
      first_deg = std::min(first_deg, late_deg);
      last_deg = std::max(last_deg, late_deg);
      ++points;
    });
    // The azimuths of a packet are rounded by 0.005 deg, 1 mm at 12 m; at grazing incidence that is more along the
    // ray. Half a unit of the range, and 0.01 deg of the nominal elevations of drivers/.
    CHECK(worst_m < 0.5 * plan.distance_unit_m + 0.006);
    CHECK(points > 50'000);
    // Rounding of azimuth and elevation, and 0.014 deg in the unit of a point's time; 0.2 deg within a firing that has
    // one azimuth.
    CHECK(last_deg - first_deg < (plan.one_azimuth ? 0.2 : 0.0) + 0.05);
    CHECK(std::abs(first_deg) < 0.2);
  }
}

TEST_CASE(
    "Of a driving robot every point is on the walls: each laser fires at its own time from its own pose") {
  const Trajectory drive = driving();
  for (const LidarPlan& plan : lidar_plans()) {
    CAPTURE(plan.name);
    std::vector<double> distances;
    double high_deg = -90.0;
    double low_deg = 90.0;
    decode(plan, drive, LidarErrors{}, 0.7, [&](const ScanPoint& point, double time_s) {
      const MotionState state = drive.at(time_s);
      const Vector3d p(point.x_m, point.y_m, point.z_m);
      const Vector3d p_base = kOnRobot.T_base_sensor() * p;
      distances.push_back(wall_distance(state.p_world + state.q_world_base * p_base));
      const double elevation_deg = std::atan2(p.z(), std::hypot(p.x(), p.y())) / kDegree;
      high_deg = std::max(high_deg, elevation_deg);
      low_deg = std::min(low_deg, elevation_deg);
      if (plan.sweep == LidarSweep::kRosette && point.ring != 0) FAIL("a ring without lasers");
    });
    CHECK(distances.size() > 120'000);
    // As in the test before; in 0.7 s the clock's anchor rises by 0.1 ms, at 0.6 rad/s and 12 m 1 mm.
    CHECK(*std::max_element(distances.begin(), distances.end()) < 0.5 * plan.distance_unit_m + 0.006);
    if (plan.sweep != LidarSweep::kRosette) continue;
    CHECK(high_deg == doctest::Approx(52.0).epsilon(0.005));
    CHECK(low_deg == doctest::Approx(-7.0).epsilon(0.02));
  }
}

TEST_CASE("With the errors of its data sheet a model's points scatter about the walls as that says") {
  const Trajectory stand = standing();
  for (const LidarPlan& plan : lidar_plans()) {
    CAPTURE(plan.name);
    const LidarErrors errors = LidarErrors::draw(Random(7), plan);
    std::vector<double> distances;
    decode(plan, stand, errors, 0.4, [&](const ScanPoint& point, double) {
      distances.push_back(
          wall_distance(kOnRobot.T_base_sensor() * Vector3d(point.x_m, point.y_m, point.z_m)));
    });
    REQUIRE(distances.size() > 50'000);
    std::sort(distances.begin(), distances.end());
    const auto quantile = [&](double share) {
      return distances[static_cast<std::size_t>(share * static_cast<double>(distances.size() - 1))];
    };
    // Range noise, the bias of a laser, and at 12 m the direction's noise; 5 mm for the smear of the beam at grazing
    // incidence and for rounding.
    const double sigma_m =
        std::hypot(plan.range.sigma_high_m, plan.range.bias_sigma_m, 12.0 * plan.range.angle_sigma_rad);
    CHECK(quantile(0.999) < 4.0 * sigma_m + 0.005);
    CHECK(quantile(0.5) > 0.1 * plan.range.sigma_low_m);
  }
}

TEST_CASE("The patterns of a Mid-360 differ from turn to turn, and those of a rotor do not") {
  const World room = box_room();
  const Trajectory stand = standing();
  // Whether all ranges of a packet come again after a tenth of a second: `count` fields of 4 bytes.
  const auto repeats = [&](const char* name, std::size_t first_byte, std::size_t stride, std::size_t count) {
    const LidarPlan& plan = find_lidar_plan(name);
    const simulation::LidarModel lidar(plan, room, stand, kOnRobot.T_base_sensor(), LidarErrors{}, 1);
    const auto later = static_cast<std::uint64_t>(std::llround(0.1 / lidar.packet_time_s(1)));
    const PacketBytes a = lidar.packet(0).bytes;
    const PacketBytes b = lidar.packet(later).bytes;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::ptrdiff_t>(first_byte + stride * i);
      equal += std::equal(a.begin() + at, a.begin() + at + 4, b.begin() + at) ? 1 : 0;
    }
    return static_cast<double>(equal) / static_cast<double>(count);
  };
  CHECK(repeats("OS1", 44, 12, 32) == 1.0);
  CHECK(repeats("Mid-360", 36, 14, 96) < 0.1);
}

}  // namespace isobar::test::test_simulated_lidars
