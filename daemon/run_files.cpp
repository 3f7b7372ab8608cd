// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/run_files.hpp"

#include <spdlog/spdlog.h>

#include <array>

#include "config/config_io.hpp"
#include "daemon/counts.hpp"
#include "daemon/stage_settings.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar {
namespace {

/// Store of the tiles that leave memory: the configured map
/// folder, else the run folder's; null without either.
std::unique_ptr<FileTileStore> map_store(const Config& config) {
  std::filesystem::path directory = config.map_files.directory;
  if (directory.empty() && !config.output.directory.empty()) {
    directory = files::RunOutput::map_directory(config.output.directory);
  }
  if (directory.empty()) return nullptr;
  return FileTileStore::create(directory, map_header(config), map_limits(config));
}

}  // namespace

RunFiles::RunFiles(const Config& config) : directory_(config.output.directory) {
  if (!directory_.empty()) {
    output_.emplace(directory_);
    output_->write_settings(show_config(config));
  }
  store_ = map_store(config);
}

void RunFiles::close(const StatusSnapshot& last) {
  if (!output_) return;
  std::vector<files::RunCount> counts = counts_of(last.lidar.counters, last.lidar.wrong_model_message.data());
  counts.push_back({"lidar packets of another sender", last.lidar.sender.refused, ""});
  run_counts::append(counts, counts_of(last.samples.counters));
  run_counts::append(counts, counts_of(last.samples.base));
  constexpr std::array<const char*, datagram::kKinds> kNames = {"imu", "baro", "base", "wheel"};
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    counts.push_back(
        {std::string(kNames[kind]) + " lines of another sender", last.samples.senders[kind].refused, ""});
  }
  counts.push_back({"sample datagrams of senders not allowed", last.samples.not_allowed, ""});
  if (last.barometer.present) run_counts::append(counts, counts_of(last.barometer.device.counters));
  counts.push_back({"baro lines refused", last.samples.refused_pressure, ""});
  run_counts::append(counts, counts_of(last.prior.counters));
  counts.push_back({"shared memory faults", ipc::library_fault_count(), ""});
  run_counts::append(counts, counts_of_map(*store_, *output_));  // a run folder implies a store
  output_->close(counts);
  spdlog::info("{} poses and {} map points in {}", output_->poses(), output_->map_points(),
               directory_.string());
}

}  // namespace isobar
