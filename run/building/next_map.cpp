// SPDX-License-Identifier: BSD-3-Clause
#include "run/building/next_map.hpp"

#include <fcntl.h>

#include <array>
#include <system_error>

#include "core/errors.hpp"
#include "run/building/building_store.hpp"
#include "run/tile_store/map_folder.hpp"

namespace isobar {

namespace fs = std::filesystem;

namespace {

constexpr const char* kComplete = "complete";

fs::path beside(const fs::path& map_folder, const char* ending) {
  const fs::path whole = map_folder.has_filename() ? map_folder : map_folder.parent_path();
  return whole.string() + ending;
}

void check(const std::error_code& error, const fs::path& file) {
  if (error)
    throw ServiceError(file.string() + ": cannot be exchanged for the corrected map: " + error.message());
}

/// What is not of the old map's tiles goes over.
void take_over_files(const fs::path& from, const fs::path& to) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(from, error)) {
    if (is_of_tiles(entry.path())) continue;
    fs::rename(entry.path(), to / entry.path().filename(), error);
    check(error, entry.path());
  }
}

}  // namespace

std::unique_ptr<FileTileStore> create_next_map(const fs::path& map_folder, const MapHeader& header,
                                               const TileStoreLimits& limits) {
  remove_next_map(map_folder);
  return FileTileStore::create(beside(map_folder, ".next"), header, limits);
}

void remove_next_map(const fs::path& map_folder) {
  std::error_code error;
  fs::remove_all(beside(map_folder, ".next"), error);
}

void complete_next_map(const fs::path& map_folder) {
  const fs::path next = beside(map_folder, ".next");
  sync_folder(next);
  const fs::path mark = next / kComplete;
  const FileDescriptor file(::open(mark.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
  if (!file) throw ServiceError(mark.string() + ": cannot be written: " + errno_message());
  sync_folder(next);
}

bool settle_next_map(const fs::path& map_folder) {
  const fs::path next = beside(map_folder, ".next");
  const fs::path old = beside(map_folder, ".old");
  std::error_code error;
  const bool complete = fs::exists(next / kComplete, error);
  if (complete && fs::exists(map_folder, error)) {
    take_over_files(map_folder, next);
    fs::remove_all(old, error);
    fs::rename(map_folder, old, error);
    check(error, map_folder);
  }
  if (complete) {
    fs::rename(next, map_folder, error);
    check(error, next);
    fs::remove(map_folder / kComplete, error);
    sync_folder(map_folder.parent_path());
  }
  fs::remove_all(next, error);
  fs::remove_all(old, error);
  return complete;
}

}  // namespace isobar
