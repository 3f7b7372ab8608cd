// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/map_stores.hpp"

#include <sys/statvfs.h>

#include <algorithm>
#include <vector>

#include "core/errors.hpp"
#include "daemon/stage_settings.hpp"
#include "run/building/next_map.hpp"
#include "run/files/run_output.hpp"

namespace isobar {

namespace fs = std::filesystem;

MapStores::MapStores(const Config& config) : header_(map_header(config)), limits_(map_limits(config)) {
  if (!config.map_files.directory.empty()) {
    first_ = config.map_files.directory;
    beside_ = false;
    files::refuse_foreign_folder(first_, "map.toml", "map.directory");
  } else if (!config.output.directory.empty()) {
    first_ = files::RunOutput::map_directory(config.output.directory);
  }
}

fs::path MapStores::folder_of(std::uint32_t session) const {
  if (read_only_) return read_only_folder_;
  if (session <= 1) return first_;
  const std::string name = files::name_of_session(files::kMapDirectory, session);
  return beside_ ? first_.parent_path() / name : first_ / name;
}

std::uint32_t MapStores::newest_session() const {
  std::error_code error;
  if (!configured() || !fs::exists(first_, error)) return 0;
  const std::uint32_t later = files::newest_session(beside_ ? first_.parent_path() : first_);
  return std::max<std::uint32_t>(later, fs::exists(first_ / "map.toml", error) ? 1 : 0);
}

FileTileStore* MapStores::open(std::uint32_t session) {
  if (!configured()) return nullptr;
  const fs::path folder = folder_of(session);
  session_ = session;
  store_.reset();
  journal_.reset();
  settle_next_map(folder);
  std::error_code error;
  if (fs::exists(folder / "map.toml", error)) {
    store_ = FileTileStore::open_to_continue(folder, header_, limits_);
  } else if (fs::exists(folder, error) && !file_numbers(folder, kTilesExtension).empty()) {
    throw DataError(folder.string() + ": holds tiles of a map but no map.toml");
  } else {
    store_ = FileTileStore::create(folder, header_, limits_);
  }
  journal_.emplace(folder);
  return store_.get();
}

void MapStores::open_read_only(const fs::path& folder) {
  journal_.reset();
  store_ = FileTileStore::open_to_read(folder);
  read_only_folder_ = folder;
  read_only_.emplace(*store_);
}

std::size_t MapStores::read_journal(const std::function<void(const RegisteredScan&)>& visit) {
  return journal_ ? ScanJournal::read(folder_of(session_), visit) : 0;
}

void MapStores::post_for_flush() noexcept {
  if (read_only_) return;
  if (store_) tile_flusher_.post(store_->newest_file());
  if (journal_) {
    if (FileDescriptor scans = journal_->newest_file()) scan_flusher_.post(std::move(scans));
  }
}

bool MapStores::flush() noexcept {
  const bool tiles = tile_flusher_.flush();
  return scan_flusher_.flush() && tiles;
}

void MapStores::finish() noexcept {
  if (store_ && journal_ && DiskFlusher::wait_for(store_->newest_file())) journal_->clear();
}

bool MapStores::disk_is_full() const {
  fs::path folder = fs::absolute(first_);
  std::error_code error;
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  struct statvfs disk {};
  return ::statvfs(folder.c_str(), &disk) == 0 && (disk.f_bavail == 0 || (disk.f_flag & ST_RDONLY) != 0);
}

bool MapStores::in_place() const { return read_only_ || store_ == nullptr || store_->in_place(); }

FileTileStore* MapStores::open_again() {
  const std::unique_ptr<FileTileStore> lost = std::move(store_);
  open(session_);
  std::vector<std::byte> bytes;
  for (const TileKey& key : lost->keys()) {
    if (!store_->contains(key) && lost->take(key, bytes)) store_->put(key, bytes);
  }
  return store_.get();
}

}  // namespace isobar
