// SPDX-License-Identifier: BSD-3-Clause
// Stand-in for isobard: holds the broker and publishes the data of stand_in.hpp in real time until SIGTERM.
// Prints "ready", then once a second the number of priors published ("priors N"), and each base-station
// pressure received, with its age on the stand-in's clock: "base PASCAL MILLISECONDS STATION VARIANCE
// DEGREES", each wheel sample: "wheel VX VX_VARIANCE WZ_VARIANCE", and each hint: "hint X Y Z HAS_Z YAW SESSION
// SOURCE X_VARIANCE".
//   stand_in [--initializing]
// --initializing: every pose is one of the bootstrap.
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <chrono>
#include <cstdio>
#include <ctime>
#include <string_view>

#include "core/errors.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/integration/dds/stand_in.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a test's helper

/// Waits until `time`, or for SIGTERM.
/// @return true on SIGTERM
bool wait_until(std::chrono::steady_clock::time_point time, const sigset_t& stop) {
  const auto left = time - std::chrono::steady_clock::now();
  const auto left_ns = std::max<std::int64_t>(0, left / std::chrono::nanoseconds(1));
  const timespec limit{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  return sigtimedwait(&stop, nullptr, &limit) > 0;
}

void publish_scan(ipc::Publisher<RegisteredScan>& scans, const PoseEstimate& pose) {
  RegisteredScan* scan = scans.loan();
  if (scan == nullptr) {
    return;
  }
  scan->pose = pose;
  scan->point_count = stand_in::kScanPoints;
  for (std::uint32_t i = 0; i < scan->point_count; ++i) {
    scan->points[i] = stand_in::point_at(i);
  }
  scans.publish(scan);
}

/// Publishes the piece of the map that begins at `first_point`.
void publish_map(ipc::Publisher<ipc::MapCloud>& maps, const PoseEstimate& pose, std::uint32_t sequence,
                 std::uint32_t first_point) {
  ipc::MapCloud* map = maps.loan();
  if (map == nullptr) {
    return;
  }
  map->stamp_ns = pose.stamp_ns;
  map->sequence = sequence;
  map->first_point = first_point;
  map->total_points = stand_in::kMapPoints;
  map->point_count = std::min(ipc::MapCloud::kMaxPoints, map->total_points - first_point);
  for (std::uint32_t i = 0; i < map->point_count; ++i) {
    map->points[i] = stand_in::point_at(first_point + i);
  }
  maps.publish(map);
}

/// Publishes the rows of the grid from `first_row` on.
/// @return the first row of the next piece
std::uint32_t publish_grid(ipc::Publisher<ipc::FloorGrid>& grids, std::int64_t stamp_ns,
                           std::uint32_t first_row) {
  ipc::FloorGrid* grid = grids.loan();
  if (grid == nullptr) return first_row;
  grid->stamp_ns = stamp_ns;
  grid->sequence = 1;
  grid->floor = stand_in::kFloor;
  ipc::copy_to_field(stand_in::kFloorName, grid->floor_name);
  grid->z_m = stand_in::kFloorZM;
  grid->resolution_m = stand_in::kGridResolutionM;
  grid->origin_x_m = stand_in::kGridOriginXM;
  grid->origin_y_m = stand_in::kGridOriginYM;
  grid->width = stand_in::kGridWidth;
  grid->height = stand_in::kGridHeight;
  grid->first_row = first_row;
  grid->row_count = std::min(ipc::FloorGrid::kMaxCells / grid->width, grid->height - first_row);
  for (std::uint32_t i = 0; i < grid->row_count * grid->width; ++i) {
    grid->cells[i] = stand_in::cell_at(first_row * grid->width + i);
  }
  const std::uint32_t next = first_row + grid->row_count;
  grids.publish(grid);
  return next;
}

void publish_floor(ipc::Publisher<ipc::CurrentFloor>& floors, std::int64_t stamp_ns) {
  ipc::CurrentFloor floor;
  floor.stamp_ns = stamp_ns;
  floor.known = true;
  floor.number = stand_in::kFloor;
  floor.certainty = 0.997;
  floor.z_m = stand_in::kFloorZM;
  ipc::copy_to_field(stand_in::kFloorName, floor.name);
  floors.send(floor);
}

void publish_health(ipc::Publisher<ipc::HealthReport>& reports, std::int64_t stamp_ns,
                    std::int64_t clock_offset_ns) {
  ipc::HealthReport* report = reports.loan();
  if (report == nullptr) {
    return;
  }
  report->stamp_ns = stamp_ns;
  report->robot_clock_offset_ns = clock_offset_ns;
  static_cast<void>(report->add("lidar/packets", ipc::HealthLevel::kOk, "", 754.0));
  static_cast<void>(report->add("lidar/packets_lost", ipc::HealthLevel::kWarning, "gaps in time", 3.0));
  reports.publish(report);
}

int run(bool is_initializing) {
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
  const ipc::Broker broker;
  ipc::Publisher<Prior> priors(ipc::topics::kPrior);
  ipc::Publisher<PoseEstimate> poses(ipc::topics::kPose);
  ipc::Publisher<RegisteredScan> scans(ipc::topics::kRegisteredScan);
  ipc::Publisher<ipc::MapCloud> maps(ipc::topics::kMapCloud);
  ipc::Publisher<ipc::FloorGrid> grids(ipc::topics::kFloorGrid);
  ipc::Publisher<ipc::CurrentFloor> floors(ipc::topics::kFloor);
  ipc::Publisher<ipc::HealthReport> reports(ipc::topics::kHealth);
  ipc::Subscriber<PressureSample> base_pressure(ipc::topics::kBaseBarometer);
  ipc::Subscriber<WheelSample> wheels(ipc::topics::kWheel);
  ipc::Subscriber<ipc::PoseHint> hints(ipc::topics::kPoseHint);
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t start_ns =
      std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  const std::int64_t clock_offset_ns = start_ns - start.time_since_epoch() / std::chrono::nanoseconds(1);
  std::uint32_t grid_row = 0;
  std::puts("ready");
  for (std::uint64_t step = 0;; ++step) {
    priors.send(stand_in::prior_at(start_ns, step));
    if (step % stand_in::kPriorsPerScan == 0) {
      PoseEstimate pose = stand_in::pose_at(start_ns, step);
      if (is_initializing) pose.mode = PoseMode::kInitializing;
      poses.send(pose);
      publish_scan(scans, pose);
    }
    if (step % 200 == 0) {
      publish_health(reports, stand_in::prior_at(start_ns, step).stamp_ns, clock_offset_ns);
      std::printf("priors %llu\n", static_cast<unsigned long long>(step));
      std::fflush(stdout);
    }
    // A map every 2 s, its pieces 0.1 s apart.
    if (const std::uint64_t piece = step % 400 / 20; step % 20 == 0 && piece < stand_in::kMapPieces) {
      publish_map(maps, stand_in::pose_at(start_ns, step), static_cast<std::uint32_t>(step / 400),
                  static_cast<std::uint32_t>(piece) * ipc::MapCloud::kMaxPoints);
    }
    // The same grid again every 2 s, as isobard does; the floor once a second.
    if (step % 400 == 0 || (step % 20 == 0 && grid_row < stand_in::kGridHeight)) {
      if (step % 400 == 0) grid_row = 0;
      grid_row = publish_grid(grids, start_ns, grid_row);
    }
    if (step % 200 == 0) publish_floor(floors, start_ns);
    while (const auto hint = hints.take()) {
      std::printf("hint %.3f %.3f %.3f %d %.4f %u %d %.4f\n", hint->x_m, hint->y_m, hint->z_m,
                  static_cast<int>(hint->has_z), hint->yaw_rad, hint->session, static_cast<int>(hint->source),
                  hint->covariance[0]);
      std::fflush(stdout);
    }
    while (const auto sample = wheels.take()) {
      std::printf("wheel %.2f %.4f %.4f\n", sample->vx_m_s, sample->vx_variance_m2_s2,
                  sample->wz_variance_rad2_s2);
      std::fflush(stdout);
    }
    while (const auto sample = base_pressure.take()) {
      const std::int64_t age_ns = stand_in::prior_at(start_ns, step).stamp_ns - sample->stamp_ns;
      std::printf("base %.2f %lld %d %.4f %.2f\n", sample->pressure_pa,
                  static_cast<long long>(age_ns / 1'000'000), sample->station, sample->variance_pa2,
                  sample->temperature_c);
      std::fflush(stdout);
    }
    const auto next = std::chrono::nanoseconds((step + 1) * stand_in::kPriorPeriodNs);
    if (wait_until(start + next, stop)) {
      return 0;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 && std::string_view(argv[1]) == "--initializing");
  } catch (const Error& error) {
    std::puts(error.what());
    return error.exit_code();
  }
}
