// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/record_session.hpp"

#include <sys/statvfs.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "core/errors.hpp"

namespace isobar::recording {
namespace {

/// Largest change of the robot clock with which a recording goes on: stamps of one folder must not jump.
constexpr std::int64_t kMaxClockChangeNs = 1'000'000'000;

LiveCounts sum(LiveCounts a, const LiveCounts& b) {
  a.packets += b.packets;
  a.clouds += b.clouds;
  a.imu += b.imu;
  a.pressure += b.pressure;
  a.base_pressure += b.base_pressure;
  a.wheel += b.wheel;
  a.too_long += b.too_long;
  return a;
}

}  // namespace

std::uint64_t free_bytes(const std::filesystem::path& path) {
  std::filesystem::path existing = std::filesystem::absolute(path);
  std::error_code error;
  while (!std::filesystem::exists(existing, error) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  struct statvfs status {};
  if (::statvfs(existing.c_str(), &status) != 0) {
    throw ServiceError(existing.string() + ": free space unknown: " + std::generic_category().message(errno));
  }
  return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

void RecordSession::add(const LogEntry& entry) {
  if (entry.kind == LogKind::kDescription) {
    describe(entry);
  } else if (entry.kind == LogKind::kLosses) {
    lost_ = entry.losses;
  } else if (recording_) {
    recording_->add(entry);
  }
}

void RecordSession::describe(const LogEntry& entry) {
  const bool clock_set = std::abs(entry.robot_clock_offset_ns - clock_offset_ns_) > kMaxClockChangeNs;
  if (recording_ && entry.manifest == manifest_ && !clock_set) {
    if (entry.settings != settings_) {
      notes_.emplace_back("isobard's settings have changed; settings.toml has those of the start");
    }
    settings_ = entry.settings;
    return;
  }
  if (recording_) {
    notes_.emplace_back(clock_set ? "the robot clock was set: a new folder begins"
                                  : "sensors or mounts have changed: a new folder begins");
    closed_ = counts();
    recording_->close(true);
    recording_.reset();
  }
  open(entry);
}

void RecordSession::open(const LogEntry& entry) {
  std::vector<std::string> ignored;
  const Manifest manifest = parse_manifest(entry.manifest, "description of isobard", ignored);
  std::filesystem::path folder = folder_;
  if (!folders_.empty()) folder += "-" + std::to_string(folders_.size() + 1);
  recording_.emplace(folder, manifest, entry.settings);
  folders_.push_back(folder);
  manifest_ = entry.manifest;
  settings_ = entry.settings;
  clock_offset_ns_ = entry.robot_clock_offset_ns;
  notes_.push_back("recording to " + folder.string());
}

void RecordSession::flush() {
  if (!recording_) return;
  recording_->flush();
  sync_folder(folders_.back());
}

void RecordSession::close() {
  if (recording_) recording_->close(true);
}

LiveCounts RecordSession::counts() const { return recording_ ? sum(closed_, recording_->counts()) : closed_; }

std::uint64_t RecordSession::bytes() const {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& folder : folders_) {
    for (const auto& file : std::filesystem::directory_iterator(folder, error)) {
      const auto size = file.file_size(error);
      bytes += error ? 0 : size;
    }
  }
  return bytes;
}

std::vector<std::string> RecordSession::take_notes() { return std::exchange(notes_, {}); }

}  // namespace isobar::recording
