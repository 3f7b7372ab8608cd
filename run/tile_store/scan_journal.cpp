// SPDX-License-Identifier: BSD-3-Clause
#include "run/tile_store/scan_journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <numeric>
#include <span>
#include <system_error>
#include <utility>

#include "core/so3.hpp"
#include "run/tile_store/map_folder.hpp"
#include "run/tile_store/scan_record.hpp"

namespace isobar {

namespace fs = std::filesystem;

namespace {

/// Content of a part; empty when it cannot be read.
std::vector<std::byte> content_of(const fs::path& file) {
  const FileDescriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  if (!in || error) return {};
  std::vector<std::byte> bytes(std::min<std::uintmax_t>(size, 2 * ScanJournal::kMaxBytes));
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(in.get(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

}  // namespace

ScanJournal::ScanJournal(fs::path directory) : directory_(std::move(directory)) {
  for (const std::uint32_t number : file_numbers(directory_, kScansExtension)) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(numbered_file(directory_, number, kScansExtension), error);
    parts_.push_back({number, error ? 0 : size});
    next_number_ = number + 1;
  }
}

bool ScanJournal::wants(const PoseEstimate& pose) const {
  if (!started_ || pose.session != last_pose_.session) return true;
  const Eigen::Isometry3d step = last_pose_.T_map_base.inverse(Eigen::Isometry) * pose.T_map_base;
  return step.translation().norm() >= kStepM ||
         rotation_angle_rad(Eigen::Quaterniond(step.linear())) >= kStepRad;
}

void ScanJournal::add(const RegisteredScan& scan) noexcept {
  if (!wants(scan.pose) || (!file_ && !open_part())) return;
  encode_scan(scan, record_);
  Part& part = parts_.back();
  const ssize_t written = ::write(file_.get(), record_.data(), record_.size());
  if (written != static_cast<ssize_t>(record_.size())) {
    // A part of a record would hide all later ones.
    if (::ftruncate(file_.get(), static_cast<off_t>(part.bytes)) != 0) file_ = FileDescriptor();
    return;
  }
  part.bytes += record_.size();
  last_pose_ = scan.pose;
  started_ = unsynced_ = true;
  while (parts_.size() > 1 && disk_bytes() > kMaxBytes) remove_oldest();
}

bool ScanJournal::open_part() noexcept {
  const fs::path name = numbered_file(directory_, next_number_, kScansExtension);
  file_ = FileDescriptor(::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644));
  if (file_) parts_.push_back({next_number_++, 0});
  return static_cast<bool>(file_);
}

void ScanJournal::begin_sweep(bool whole) noexcept {
  if (whole) {
    while (!parts_.empty() && parts_.front().number < in_tiles_) remove_oldest();
    in_tiles_ = mark_;
  }
  file_ = FileDescriptor();
  mark_ = next_number_;
}

void ScanJournal::clear() noexcept {
  file_ = FileDescriptor();
  while (!parts_.empty()) remove_oldest();
}

void ScanJournal::remove_oldest() noexcept {
  std::error_code error;
  fs::remove(numbered_file(directory_, parts_.front().number, kScansExtension), error);
  parts_.pop_front();
}

FileDescriptor ScanJournal::newest_file() {
  if (!std::exchange(unsynced_, false) || !file_) return FileDescriptor();
  return FileDescriptor(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
}

std::uint64_t ScanJournal::disk_bytes() const {
  return std::accumulate(parts_.begin(), parts_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Part& part) { return sum + part.bytes; });
}

std::size_t ScanJournal::read(const fs::path& directory,
                              const std::function<void(const RegisteredScan&)>& visit) {
  const auto scan = std::make_unique<RegisteredScan>();
  std::size_t count = 0;
  for (const std::uint32_t number : file_numbers(directory, kScansExtension)) {
    const std::vector<std::byte> content = content_of(numbered_file(directory, number, kScansExtension));
    for (std::span<const std::byte> rest(content); decode_scan(rest, *scan); ++count) visit(*scan);
  }
  return count;
}

}  // namespace isobar
