// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replay_maps.hpp"

#include <utility>

#include "core/errors.hpp"
#include "daemon/base_station_names.hpp"
#include "daemon/stage_settings.hpp"
#include "run/building/next_map.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

ReplayMaps::ReplayMaps(const Config& config, const std::filesystem::path& out)
    : out_(out), header_(map_header(config)), limits_(map_limits(config)), use_(config.map_files.use) {
  const bool uses_stored = !config.map_files.stored.empty() && use_ != MapUse::kNew;
  if (localises() && !uses_stored) {
    throw ConfigError("map.use: localise needs the folder of a stored map: map.stored, or --map");
  }
  if (uses_stored) stored_ = find_stored_map(config.map_files.stored, header_, station_names(config));
  if (!stored_) {
    create(1);
  } else if (localises()) {
    stores_.push_back(FileTileStore::open_to_read(stored_->folder));
    read_only_.emplace(*stores_.back());
  } else {
    const auto own = files::RunOutput::map_directory(out_);
    copy_map(stored_->folder, own);
    stores_.push_back(FileTileStore::open_to_continue(own, header_, limits_));
  }
}

TileStorage* ReplayMaps::storage() {
  if (read_only_) return &*read_only_;
  return stores_.back().get();
}

std::unique_ptr<LoopFiles> ReplayMaps::loop_files(const Config& config) const {
  if (localises()) return nullptr;
  return std::make_unique<LoopFiles>(
      [out = out_](std::uint32_t session) { return files::RunOutput::map_directory(out, session); }, header_,
      limits_, config.loops.max_disk_gb);
}

TileStorage* ReplayMaps::exchange() {
  const auto folder = files::RunOutput::map_directory(out_, newest_);
  stores_.back().reset();
  settle_next_map(folder);
  stores_.back() = FileTileStore::open_to_continue(folder, header_, limits_);
  return stores_.back().get();
}

TileStorage* ReplayMaps::create(std::uint32_t session) {
  const auto folder = files::RunOutput::map_directory(out_, session);
  remove_next_map(folder);
  stores_.push_back(FileTileStore::create(folder, header_, limits_));
  newest_ = session;
  return stores_.back().get();
}

void ReplayMaps::begin(LockStep& pipeline, std::vector<std::string>& notes) {
  pipeline.use_maps({.open = [this](std::uint32_t session) { return create(session); },
                     .read = [this](std::uint32_t session) { return read_known_map(store(), session); }});
  if (!stored_) return;
  if (std::string note = height_note(*stored_); !note.empty()) notes.push_back(std::move(note));
  if (localises()) {
    pipeline.localise_in(stored_->start);
  } else {
    pipeline.continue_from(stored_->start, files::RunOutput::map_directory(out_));
  }
}

void ReplayMaps::write_checkpoint(const CheckpointDraft& last, const HeightDatum& datum) const {
  if (localises() || !last.due()) return;
  const files::Checkpoint checkpoint = last.at(datum.stamp_ns, datum);
  const auto map = files::RunOutput::map_directory(out_, checkpoint.session);
  files::write_checkpoint(map / files::kCheckpointFile, checkpoint);
}

}  // namespace isobar
