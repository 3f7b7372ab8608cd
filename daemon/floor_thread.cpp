// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/floor_thread.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "daemon/cpu_time.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/message_loop.hpp"
#include "daemon/status_figures.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "run/floors/stored_floors.hpp"

namespace isobar {

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr double kStandsM = 0.3;             // moved since the last round
constexpr unsigned kLongestRestDoubled = 3;  // times: a robot that stands in an unchanged map

bool are_equal(const ipc::CurrentFloor& a, const ipc::CurrentFloor& b) {
  return a.session == b.session && a.known == b.known && a.place == b.place && a.number == b.number &&
         std::strncmp(a.name, b.name, sizeof(a.name)) == 0;
}

}  // namespace

FloorThread::FloorThread(const FloorSettings& settings, FloorFeed& feed, MapFolder map_folder,
                         ThreadSettings scheduling)
    : settings_(settings),
      feed_(feed),
      map_folder_(std::move(map_folder)),
      stage_(settings.grid),
      waiter_({&poses_.raw()}),
      worker_(std::move(scheduling), waiter_, [this] { loop(); }) {}

void FloorThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
}

void FloorThread::drain() noexcept {
  try {
    take_poses();
    if (stage_.session() == 0) return;
    FloorTiles tiles = feed_.take();
    stage_.add_tiles(tiles);
    map_is_whole_ = map_is_whole_ || (tiles.is_whole && tiles.session == stage_.session() &&
                                      tiles.map_moves == stage_.map_moves());
    const std::int64_t now_ns = RobotClock::now_ns();
    follow_names(now_ns);
    if (!asked_ && now_ns - round_ns_ >= wait_ns() / 2) {
      feed_.ask();
      asked_ = true;
    }
    if (round_is_due(now_ns)) run_round(now_ns);
    const ipc::CurrentFloor floor = stage_.current();
    const bool is_other = grid_session_ != floor.session || grid_floor_ != floor.number;
    if (is_other && floor.known) offer_grid(floor, now_ns);
    publish(floor, now_ns);
    publish_known(now_ns);
    grids_.step(now_ns);
  } catch (const std::exception& error) {
    // Only memory can be refused here: files and grids have errors of their own.
    spdlog::error("floors: {}", error.what());
  }
}

void FloorThread::take_poses() {
  while (const auto pose = poses_.take()) {
    if (pose->session != stage_.session()) begin_session(pose->session);
    if (pose->map_moves != stage_.map_moves()) map_is_whole_ = asked_ = false;
    stage_.add_pose(*pose);
    draft_.started = true;
    draft_.sigma_m = std::sqrt(std::max(pose->covariance(2, 2), 0.0));
  }
}

// A run that is continued has driven before.
void FloorThread::begin_session(std::uint32_t session) {
  folder_ = map_folder_(session);
  std::vector<Eigen::Vector3d> path;
  try {
    if (!folder_.empty()) path = files::path_of(files::trajectory_of_map(folder_));
  } catch (const std::exception& error) {
    spdlog::warn("floors: {}; those that were driven before are not told until they are driven again",
                 error.what());
  }
  stage_.begin(session, path);
  list_is_old_ = true;
  map_is_whole_ = asked_ = false;
  names_ns_ = 0;
  names_changed_ = {};
  round_ns_ = 0;
}

// Once a second: `isobar map floors --name` changes the file.
void FloorThread::follow_names(std::int64_t now_ns) {
  if (folder_.empty() || now_ns - names_ns_ < kSecondNs) return;
  names_ns_ = now_ns;
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(folder_ / files::kFloorNamesFile, error);
  const auto known = error ? std::filesystem::file_time_type{} : changed;
  if (known == names_changed_) return;
  names_changed_ = known;
  try {
    stage_.set_names(files::FloorNames::read(folder_));
    list_is_old_ = true;
    draft_.names_unreadable = false;
  } catch (const std::exception& why) {
    spdlog::warn("floors: {}; the names before it hold", why.what());
    draft_.names_unreadable = true;
  }
}

std::int64_t FloorThread::wait_ns() const {
  const double rest_s =
      settings_.interval_s * static_cast<double>(1U << std::min(equal_grids_, kLongestRestDoubled));
  return static_cast<std::int64_t>(1e9 * std::max(rest_s, 1e-3 * cpu_ms_ / settings_.cpu_share));
}

bool FloorThread::round_is_due(std::int64_t now_ns) const {
  const bool moved = (stage_.p_map_base() - p_map_round_).norm() > kStandsM;
  const std::int64_t wait =
      moved ? static_cast<std::int64_t>(1e9 *
                                        std::max(settings_.interval_s, 1e-3 * cpu_ms_ / settings_.cpu_share))
            : wait_ns();
  return map_is_whole_ && now_ns - round_ns_ >= wait;
}

void FloorThread::run_round(std::int64_t now_ns) {
  const CpuTimer timer;
  stage_.find();
  list_is_old_ = true;
  cpu_ms_ = timer.elapsed_ms();
  offer_grid(stage_.current(), now_ns);
  draft_.round_ms = cpu_ms_;
  map_is_whole_ = asked_ = false;
  p_map_round_ = stage_.p_map_base();
  round_ns_ = RobotClock::now_ns();
}

void FloorThread::offer_grid(const ipc::CurrentFloor& floor, std::int64_t now_ns) {
  const GridOrigin origin{floor.stamp_ns, floor.session, floor.number, floor.name};
  if (!grids_.is_due(origin, now_ns)) return;
  const CpuTimer timer;
  try {
    std::optional<OccupancyGrid> grid = stage_.grid();
    const bool is_new = grid && grids_.offer(std::move(*grid), origin, now_ns);
    const bool stood = (stage_.p_map_base() - p_map_round_).norm() <= kStandsM;
    equal_grids_ = is_new || !stood ? 0 : equal_grids_ + 1;
    if (grid) {
      grid_session_ = floor.session;
      grid_floor_ = floor.number;
    }
    draft_.grid_too_large = false;
  } catch (const DataError& error) {
    if (!draft_.grid_too_large) spdlog::warn("floors: {}", error.what());
    draft_.grid_too_large = true;
  }
  cpu_ms_ += timer.elapsed_ms();
}

void FloorThread::publish(const ipc::CurrentFloor& floor, std::int64_t now_ns) {
  draft_.floor = floor;
  status_.put(draft_);
  if (are_equal(floor, published_) && now_ns - published_ns_ < kSecondNs) return;
  ipc::CurrentFloor* message = floors_.loan();
  if (message == nullptr) return;
  *message = floor;
  floors_.publish(message);
  published_ = floor;
  published_ns_ = now_ns;
}

void FloorThread::publish_known(std::int64_t now_ns) {
  if (!list_is_old_ || now_ns - listed_ns_ < kSecondNs) return;
  const ipc::KnownFloors known = stage_.known();
  if (known == listed_) {
    list_is_old_ = false;
    return;
  }
  ipc::KnownFloors* message = lists_.loan();
  if (message == nullptr) return;
  *message = known;
  lists_.publish(message);
  list_is_old_ = false;
  listed_ = known;
  listed_ns_ = now_ns;
}

void add_floor(const FloorStatus& status, ipc::HealthReport& report) {
  using ipc::HealthLevel;
  if (!status.started) return;
  const ipc::CurrentFloor& floor = status.floor;
  fill_floor(floor, report.status.floor);
  const bool has_floors = std::isfinite(floor.z_m);
  const std::string name(floor.name, strnlen(floor.name, sizeof(floor.name)));
  const std::string which = std::to_string(floor.number) + (name.empty() ? "" : " (" + name + ")");
  const bool is_uncertain = has_floors && floor.place == FloorPlace::kUnknown;
  std::string text = !has_floors    ? "none known yet"
                     : floor.known  ? fmt::format("{}, certain to {:.0f} %", which, 100.0 * floor.certainty)
                     : is_uncertain ? fmt::format("not known: the height is uncertain by {:.1f} m; last: {}",
                                                  status.sigma_m, which)
                                    : fmt::format("{}; last: {}", kFloorPlaceTexts.name(floor.place), which);
  if (status.names_unreadable) text += "; floors.toml cannot be read";
  if (status.grid_too_large) text += "; its grid is too large";
  const bool is_well = !is_uncertain && !status.names_unreadable && !status.grid_too_large;
  add_entry(report, "floor", is_well ? HealthLevel::kOk : HealthLevel::kWarning, text, floor.number);
}

}  // namespace isobar
