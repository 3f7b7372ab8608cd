// SPDX-License-Identifier: BSD-3-Clause
#include "run/building/building_store.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "run/building/building_log.hpp"
#include "run/tile_store/scan_record.hpp"

namespace isobar {

namespace fs = std::filesystem;

namespace {

constexpr const char* kLogFile = "building.log";
// A scan of kMostScanPoints.
constexpr std::size_t kMostScanBytes = 104 + std::size_t{8} * kMostScanPoints;
constexpr std::size_t kMostWaitingBytes = 16U << 20;  // of ten hours
constexpr std::uint64_t kMostLogBytes = 1U << 30;     // of 100 000 submaps

ScanHandle handle_of(std::uint32_t part, std::uint64_t offset) { return (ScanHandle{part} << 32U) | offset; }

/// Reads up to `bytes.size()` bytes at an offset; shortens `bytes` to what there was.
void read_at(const FileDescriptor& file, std::uint64_t offset, std::vector<std::byte>& bytes) {
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::pread(file.get(), bytes.data() + filled, bytes.size() - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
}

std::uint64_t size_of(const FileDescriptor& file) {
  struct stat status {};
  return ::fstat(file.get(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

}  // namespace

std::unique_ptr<BuildingStore> BuildingStore::open_to_continue(const fs::path& map_folder,
                                                               std::uint64_t max_bytes) {
  const fs::path folder = map_folder / kBuildingFolder;
  std::unique_ptr<BuildingStore> store(new BuildingStore(folder));
  store->max_bytes_ = max_bytes;
  std::error_code error;
  if (store->make_files()) {
    store->load();
  } else if (fs::exists(folder / kLogFile, error)) {
    throw ServiceError(store->counters_.first_refusal);
  }
  if (store->log_bytes_ == 0) {
    store->record_.clear();
    building_log::append_format(store->record_);
    store->append_log();
  }
  return store;
}

// @throws ServiceError where another process holds the lock
bool BuildingStore::make_files() {
  std::error_code error;
  fs::create_directories(folder_, error);
  const FileDescriptor lock(::open((folder_ / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!lock) {
    refuse(folder_.string() + ": cannot be begun: " + errno_message());
    return false;
  }
  if (!lock_) lock_ = std::make_unique<MapLock>(folder_);
  const fs::path log = folder_ / kLogFile;
  log_ = FileDescriptor(::open(log.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!log_) refuse(log.string() + ": cannot be opened: " + errno_message());
  return static_cast<bool>(log_);
}

// The log that could not be made at first. Records of others in it would belong to another building.
bool BuildingStore::begin_late() {
  try {
    if (!make_files()) return false;
  } catch (const Error& error) {
    refuse(error.what());
    return false;
  }
  if (size_of(log_) == 0) return true;
  refuse(folder_.string() + ": another process has begun a building there");
  log_ = FileDescriptor();
  return false;
}

std::unique_ptr<BuildingStore> BuildingStore::open_to_read(const fs::path& map_folder) {
  const fs::path folder = map_folder / kBuildingFolder;
  const fs::path log = folder / kLogFile;
  std::unique_ptr<BuildingStore> store(new BuildingStore(folder));
  store->log_ = FileDescriptor(::open(log.c_str(), O_RDONLY | O_CLOEXEC));
  if (!store->log_ && errno == ENOENT) return nullptr;
  if (!store->log_) throw ServiceError(log.string() + ": cannot be opened: " + errno_message());
  store->load();
  return store;
}

void BuildingStore::load() {
  const fs::path log = folder_ / kLogFile;
  const std::uint64_t size = size_of(log_);
  if (size > kMostLogBytes) throw DataError(log.string() + ": must not be larger than 1 GiB");
  std::vector<std::byte> bytes(size);
  read_at(log_, 0, bytes);
  building_log::LogContent content = building_log::read_log(bytes);
  if (content.format > building_log::kVersion) {
    throw DataError(log.string() + ": has format " + std::to_string(content.format) +
                    "; this program reads " + std::to_string(building_log::kVersion));
  }
  // A log that a power cut has emptied begins anew; what is no log is left alone.
  if (size >= 16 && content.whole_bytes == 0)
    throw DataError(log.string() + ": is not the log of a building");
  stored_ = std::move(content.building);
  log_bytes_ = content.whole_bytes;
  counters_.removed_bytes = size - content.whole_bytes;
  if (max_bytes_ > 0 && counters_.removed_bytes > 0 &&
      ::ftruncate(log_.get(), static_cast<off_t>(log_bytes_)) != 0) {
    throw ServiceError(log.string() + ": cannot be shortened: " + errno_message());
  }
  for (const std::uint32_t number : file_numbers(folder_, kScansExtension)) {
    std::error_code error;
    const std::uintmax_t part_bytes = fs::file_size(numbered_file(folder_, number, kScansExtension), error);
    parts_[number] = error ? 0 : part_bytes;
  }
}

void BuildingStore::refuse(const std::string& why) {
  ++counters_.refused;
  if (counters_.first_refusal.empty()) counters_.first_refusal = why;
}

// Appends bytes as a whole: a part of a record would hide all later ones.
bool BuildingStore::append(const FileDescriptor& file, std::uint64_t& size,
                           const std::vector<std::byte>& bytes) {
  const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
  if (written == static_cast<ssize_t>(bytes.size())) {
    size += bytes.size();
    return true;
  }
  refuse(folder_.string() + ": cannot be written: " + (written < 0 ? errno_message() : "the disk is full"));
  if (::ftruncate(file.get(), static_cast<off_t>(size)) != 0) refuse(folder_.string() + ": cannot be cut");
  return false;
}

// Records of the log name the ones before them: what a full disk refuses waits for the next one. Once too much waits the log
// ends where it is, whole.
void BuildingStore::append_log() {
  if (waiting_.size() > kMostWaitingBytes) return;
  waiting_.insert(waiting_.end(), record_.begin(), record_.end());
  if (!log_ && !begin_late()) return;
  if (append(log_, log_bytes_, waiting_)) waiting_.clear();
}

void BuildingStore::add_submap(const Submap& submap) {
  record_.clear();
  building_log::append_submap(submap, record_);
  append_log();
}

void BuildingStore::add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) {
  key.scan = append_scan(scan);
  record_.clear();
  building_log::append_key(submap, key, record_);
  append_log();
}

void BuildingStore::add_loop(const Loop& loop) {
  record_.clear();
  building_log::append_loop(loop, record_);
  append_log();
}

void BuildingStore::add_move(std::int64_t stamp_ns) {
  record_.clear();
  building_log::append_move(stamp_ns, record_);
  append_log();
}

ScanHandle BuildingStore::append_scan(const RegisteredScan& scan) {
  if ((!part_ || parts_.rbegin()->second >= kPartBytes) && !open_part()) return kNoScanHandle;
  encode_scan(scan, record_);
  auto& [number, size] = *parts_.rbegin();
  const std::uint64_t offset = size;
  return append(part_, size, record_) ? handle_of(number, offset) : kNoScanHandle;
}

bool BuildingStore::open_part() {
  const std::uint32_t number = parts_.empty() ? 1 : parts_.rbegin()->first + 1;
  const fs::path file = numbered_file(folder_, number, kScansExtension);
  FileDescriptor next(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644));
  if (!next) {
    refuse(file.string() + ": cannot be opened: " + errno_message());
    return false;
  }
  std::uint64_t sum = 0;
  for (const auto& part : parts_) sum += part.second;
  while (!parts_.empty() && sum > max_bytes_) {
    std::error_code error;
    fs::remove(numbered_file(folder_, parts_.begin()->first, kScansExtension), error);
    sum -= parts_.begin()->second;
    parts_.erase(parts_.begin());
    ++counters_.forgotten;
  }
  part_ = std::move(next);
  parts_[number] = 0;
  return true;
}

bool BuildingStore::read_scan(ScanHandle handle, RegisteredScan& out) {
  const auto number = static_cast<std::uint32_t>(handle >> 32U);
  const std::uint64_t offset = handle & 0xFFFFFFFFU;
  if (!reading_ || reading_number_ != number) {
    const fs::path file = numbered_file(folder_, number, kScansExtension);
    reading_ = FileDescriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    reading_number_ = number;
  }
  reading_bytes_.resize(kMostScanBytes);
  if (reading_) read_at(reading_, offset, reading_bytes_);
  std::span<const std::byte> rest(reading_bytes_);
  if (reading_ && decode_scan(rest, out)) return true;
  ++counters_.damaged;
  return false;
}

bool BuildingStore::sync() noexcept {
  const bool part = !part_ || ::fdatasync(part_.get()) == 0;
  return ::fdatasync(log_.get()) == 0 && part;
}

}  // namespace isobar
