// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_files.hpp"
#include "daemon/contradictions.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/mounts/mount_text.hpp"
#include "daemon/base_station_names.hpp"
#include "daemon/counts.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {
namespace {

std::string frame_name(std::uint32_t session) { return files::name_of_session("map", session); }

std::vector<files::RunCount> counts_of_threads(const StatusSnapshot& last) {
  std::vector<files::RunCount> counts = counts_of(last.lidar.counters, last.lidar.wrong_model_message.data());
  counts.push_back({"lidar packets of another sender", last.lidar.sender.refused, ""});
  run_counts::append(counts, counts_of(last.samples.counters));
  run_counts::append(counts, counts_of(last.samples.base));
  constexpr std::array<const char*, datagram::kKinds> kNames = {"imu", "baro", "base", "wheel"};
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    counts.push_back(
        {std::string(kNames[kind]) + " lines of another sender", last.samples.senders[kind].refused, ""});
    counts.push_back({std::string(kNames[kind]) + " lines refused", last.samples.refused[kind], ""});
  }
  counts.push_back({"sample datagrams of senders not allowed", last.samples.not_allowed, ""});
  if (last.barometer.present) run_counts::append(counts, counts_of(last.barometer.device.counters));
  if (last.wheels.present) {
    counts.push_back({"wheel edges lost", last.wheels.device.counters.corrupt, ""});
    counts.push_back({"wheel accesses failed", last.wheels.device.counters.io_errors, ""});
  }
  run_counts::append(counts, counts_of(last.prior.counters));
  counts.push_back({"imu samples of the other path", last.prior.imu_path.refused, ""});
  counts.push_back({"wheel samples of the other path", last.prior.wheel_path.refused, ""});
  counts.push_back({"shared memory faults", ipc::library_fault_count(), ""});
  return counts;
}

/// Does one part of the end of a run; the others follow whatever happens to it.
template <class Part>
void do_or_log(const Part& part) {
  try {
    part();
  } catch (const Error& error) {
    spdlog::error("{}", error.what());
  }
}

}  // namespace

RunFiles::RunFiles(const Config& config)
    : directory_(config.output.directory),
      configured_rpy_deg_(config.lidar.mount.rpy_deg),
      stations_(station_names(config)),
      maps_(config) {
  if (!directory_.empty()) files::refuse_foreign_folder(directory_, "", "output.directory");
  choose_stored_start(config);
  if (directory_.empty()) return;
  output_.emplace(directory_, files::Start::kContinue, start_.session);
  do_or_log([&] { output_->write_settings(run_settings(config)); });
  if (output_->removed_bytes() > 0) {
    spdlog::warn("{}: the last lines were incomplete, after a power cut; {} bytes are removed",
                 directory_.string(), output_->removed_bytes());
  }
}

std::filesystem::path RunFiles::checkpoint_file() const {
  if (!directory_.empty()) return directory_ / files::kCheckpointFile;
  if (maps_.configured()) return maps_.folder() / files::kCheckpointFile;
  return {};
}

std::unique_ptr<LoopFiles> RunFiles::loop_files(const Config& config) const {
  return std::make_unique<LoopFiles>(map_folder(), map_header(config), map_limits(config),
                                     config.loops.max_disk_gb);
}

std::uint32_t RunFiles::newest_session() const {
  const std::uint32_t run = directory_.empty() ? 0 : files::newest_session(directory_);
  return std::max(run, maps_.newest_session());
}

// A run that is begun already goes on in its own map, which may be the copy of the stored one.
void RunFiles::choose_stored_start(const Config& config) {
  const MapFileSettings& map = config.map_files;
  const std::uint32_t newest = newest_session();
  if (map.use == MapUse::kLocalise) return localise_in(map.stored, map_header(config));
  if (map.use == MapUse::kNew && newest > 0) return begin_beside(newest + 1, "map.use is new");
  const bool begun = newest > 0 && !awaits_first_pose(newest);
  if (map.use == MapUse::kNew || map.stored.empty() || !maps_.configured() || begun) return choose_start();
  if (newest == 0)
    copy_map(find_stored_map(map.stored, map_header(config), stations_).folder, maps_.folder_of(1));
  const StoredMap copy = find_stored_map(maps_.folder_of(1), map_header(config), stations_);
  static_cast<void>(open_map(1));
  start_in(copy);
}

/// @param folder of the stored map; empty: that of the run itself
void RunFiles::localise_in(const std::string& folder, const MapHeader& header) {
  const std::uint32_t own = maps_.newest_session();
  if (folder.empty() && own == 0) {
    throw ConfigError("map.use: localise needs a map: map.stored, or a run with one in output.directory");
  }
  if (!folder.empty() && own > 0) {
    throw ConfigError(
        "output.directory: " + directory_.string() +
        " holds a run with a map of its own; a run that localises in map.stored needs another folder");
  }
  StoredMap stored = find_stored_map(folder.empty() ? maps_.folder_of(own) : std::filesystem::path(folder),
                                     header, stations_);
  maps_.open_read_only(stored.folder);
  stored.start.session = stored.start.place->session = std::max(own, 1U);
  start_in(stored);
  // After a restart the robot is where this run saw it last.
  const auto checkpoint = directory_.empty() ? std::nullopt : read_own_checkpoint();
  if (checkpoint && checkpoint->session == start_.session) continue_from(*checkpoint);
}

std::optional<files::Checkpoint> RunFiles::read_own_checkpoint() const {
  try {
    return files::read_checkpoint(directory_ / files::kCheckpointFile);
  } catch (const Error& error) {
    spdlog::warn("{}", error.what());
    return std::nullopt;
  }
}

/// No pose of the run has been written: the copy of a stored map is as it was.
bool RunFiles::awaits_first_pose(std::uint32_t newest) const {
  if (newest != 1 || directory_.empty()) return false;
  std::error_code error;
  return files::has_no_pose(directory_, 1) &&
         !std::filesystem::exists(directory_ / files::kCheckpointFile, error);
}

void RunFiles::start_in(const StoredMap& stored) {
  start_ = stored.start;
  spdlog::info("begins in the stored map {}{}; its place is searched in all of it", stored.folder.string(),
               maps_.read_only() ? ", which is only read" : "");
  if (const std::string note = height_note(stored); !note.empty()) spdlog::warn("{}", note);
}

void RunFiles::continue_from(files::Checkpoint checkpoint) {
  std::string other_station = take_over_stations(checkpoint, stations_);
  if (!other_station.empty()) spdlog::warn("{}: {}", directory_.string(), other_station);
  start_ = continuation_of(checkpoint);
  start_.other_station = std::move(other_station);
}

void RunFiles::choose_start() {
  const std::uint32_t newest = newest_session();
  std::optional<files::Checkpoint> checkpoint;
  std::string why = "there is no checkpoint of it";
  try {
    if (const auto file = checkpoint_file(); !file.empty()) checkpoint = files::read_checkpoint(file);
  } catch (const Error& error) {
    why = error.what();
  }
  if (newest == 0) {
    static_cast<void>(open_map(1));
    return;
  }
  if (checkpoint && checkpoint->session != newest) why = "its newest map frame has no checkpoint";
  if ((!checkpoint || checkpoint->session != newest) && !begun(newest)) {
    start_.session = newest;
    return;
  }
  if (!checkpoint || checkpoint->session != newest) {
    begin_beside(newest + 1, why);
    return;
  }
  if (!open_map(newest)) {
    begin_beside(newest + 1, "its map cannot be continued");
    static_cast<void>(take_over_stations(*checkpoint, stations_));
    start_.datum = checkpoint->datum;
    return;
  }
  continue_from(*checkpoint);
  const Eigen::Vector3d p = checkpoint->T_map_base.translation();
  spdlog::info(
      "continues the earlier run in frame {} at ({:.2f}, {:.2f}, {:.2f}) m; the first scans must "
      "confirm the place",
      frame_name(newest), p.x(), p.y(), p.z());
}

// False for a frame that ended before its first pose: it begins again. Its map is then open.
bool RunFiles::begun(std::uint32_t session) {
  if (!directory_.empty() && !files::has_no_pose(directory_, session)) return true;
  return !open_map(session) || (maps_.current() != nullptr && maps_.current()->tile_count() > 0);
}

/// @throws ServiceError when the disk refuses or another process writes the map
/// @return false for a map that is not like the configured one
bool RunFiles::open_map(std::uint32_t session) {
  try {
    maps_.open(session);
  } catch (const DataError& error) {
    spdlog::warn("{}", error.what());
    return false;
  } catch (const ServiceError& error) {
    if (!maps_.disk_is_full()) throw;
    spdlog::error("{}; poses continue, and the map is written when the disk has room", error.what());
  }
  return true;
}

void RunFiles::begin_beside(std::uint32_t session, const std::string& why) {
  spdlog::warn("the earlier run is kept but not continued: {}; a new one begins beside it in frame {}", why,
               frame_name(session));
  start_.session = session;
  static_cast<void>(open_map(session));
}

// All threads have stopped: the map is on the disk, and its successor may take its place.
void RunFiles::lay_map(LoopStage& loops) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMostLayingS);
  if (loops.finish([&] { return std::chrono::steady_clock::now() < until; })) maps_.exchange();
}

void RunFiles::close(const StatusSnapshot& last, LoopStage* loops) {
  if (!output_) return;
  do_or_log([&] { output_->flush(); });
  if (loops != nullptr) do_or_log([&] { lay_map(*loops); });
  std::vector<files::RunCount> counts = counts_of_threads(last);
  // A run folder implies a store, unless the disk has refused a new one.
  if (maps_.current() != nullptr) {
    do_or_log([&] { run_counts::append(counts, counts_of_map(*maps_.current(), *output_)); });
  }
  if (loops != nullptr) {
    do_or_log([&] { write_corrected_trajectories(directory_, *loops); });
    run_counts::append(counts, counts_of(loops->counts()));
    counts.push_back({"maps laid anew", loops->moves(), loops->problem()});
  }
  add_contradictions(counts, last.contradictions);
  counts.push_back({"poses not written", output_->dropped_lines(), ""});
  do_or_log([&] { output_->write_counters(counts); });
  if (last.registration.effective_method == Method::kAdaptive) {
    do_or_log([&] { output_->write_mounts(mounts_file_text(last.registration.mount, configured_rpy_deg_)); });
  }
  spdlog::info("{} poses and {} map points in {}", output_->poses(), output_->map_points(),
               directory_.string());
}

}  // namespace isobar
