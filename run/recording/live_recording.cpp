// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/live_recording.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>

#include "core/errors.hpp"
#include "run/recording/csv_writer.hpp"

namespace isobar::recording {
namespace {

constexpr const char* kLiveSettingsFile = "settings.toml";

void write_new_text(const std::filesystem::path& file, std::string_view text) {
  TextFile out(file);
  out.write(text);
  out.close();
}

/// Replaces recording.toml in one step, so that a reader finds the old or the new one.
void replace_manifest(const std::filesystem::path& folder, const Manifest& manifest) {
  const std::filesystem::path draft = folder / ".recording.toml.new";
  write_new_text(draft, manifest_text(manifest));
  std::error_code error;
  std::filesystem::rename(draft, folder / kManifestFile, error);
  if (error) {
    throw DataError((folder / kManifestFile).string() + ": cannot be replaced: " + error.message());
  }
}

std::filesystem::path new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_empty(folder, error)) {
    throw DataError(folder.string() + ": exists already; a recording is written to a new folder");
  }
  return folder;
}

void sync_path(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return;
  }
  const bool refused = ::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS;
  const int reason = errno;
  ::close(descriptor);
  if (refused) {
    throw DataError(path.string() + ": could not be written to the disk: " + std::strerror(reason));
  }
}

/// Moves a sensor from the possible to the seen ones.
template <typename Entry>
bool first_of(std::uint64_t count, const std::optional<Entry>& possible, std::optional<Entry>& seen) {
  const bool first = count > 0 && possible && !seen;
  if (first) {
    seen = possible;
  }
  return first;
}

template <typename Entry>
void remove_unseen(const std::filesystem::path& folder, const std::optional<Entry>& possible,
                   const std::optional<Entry>& seen) {
  if (possible && !seen) {
    std::error_code ignored;
    std::filesystem::remove(folder / possible->file, ignored);
  }
}

}  // namespace

LiveRecording::LiveRecording(const std::filesystem::path& folder, const Manifest& manifest,
                             std::string_view settings)
    : folder_(new_folder(folder)),
      all_(manifest),
      writer_(std::make_unique<RecordingWriter>(folder, manifest, WriterOptions{.every_column = true})) {
  seen_.description = manifest.description;
  if (!settings.empty()) {
    write_new_text(folder_ / kLiveSettingsFile, settings);
  }
  flush();
}

void LiveRecording::add_datagram(const LogEntry& entry, std::uint16_t port) {
  if (entry.packet.size() > kMaxUdpPayloadBytes) {
    ++counts_.too_long;
    return;
  }
  writer_->add_packet(entry.stamp_ns, entry.packet, port, entry.sender_ipv4);
  ++counts_.packets;
}

void LiveRecording::add_scan_part(const LogEntry& entry) {
  const CloudRecord* cloud = scan_parts_.add(entry);
  if (cloud != nullptr && writer_->add_cloud(*cloud)) ++counts_.clouds;
}

void LiveRecording::add(const LogEntry& entry) {
  const bool has_packets = all_.lidar && !all_.lidar->holds_clouds();
  switch (entry.kind) {
    case LogKind::kPacket:
      if (has_packets) add_datagram(entry, all_.lidar->port);
      return;
    case LogKind::kInformation:
      if (has_packets && all_.lidar->info_port != 0) add_datagram(entry, all_.lidar->info_port);
      return;
    case LogKind::kScanPart:
      if (all_.lidar && all_.lidar->holds_clouds()) add_scan_part(entry);
      return;
    case LogKind::kImu:
      if (!all_.imu) return;
      writer_->add_imu(entry.imu);
      ++counts_.imu;
      return;
    case LogKind::kPressure:
      if (!all_.barometer) return;
      writer_->add_pressure(entry.pressure);
      ++counts_.pressure;
      return;
    case LogKind::kBasePressure:
      if (!all_.base_barometer) return;
      writer_->add_base_pressure(entry.pressure);
      ++counts_.base_pressure;
      return;
    case LogKind::kWheel:
      if (!all_.wheel) return;
      writer_->add_wheel(entry.wheel);
      ++counts_.wheel;
      return;
    case LogKind::kDescription:
    case LogKind::kLosses:
      return;
  }
}

void LiveRecording::note_seen() {
  for (const bool first : {first_of(counts_.packets + counts_.clouds, all_.lidar, seen_.lidar),
                           first_of(counts_.imu, all_.imu, seen_.imu),
                           first_of(counts_.pressure, all_.barometer, seen_.barometer),
                           first_of(counts_.base_pressure, all_.base_barometer, seen_.base_barometer),
                           first_of(counts_.wheel, all_.wheel, seen_.wheel)}) {
    manifest_is_old_ = manifest_is_old_ || first;
  }
}

void LiveRecording::flush() {
  writer_->flush();
  note_seen();
  if (manifest_is_old_) {
    replace_manifest(folder_, seen_);
    manifest_is_old_ = false;
  }
}

void LiveRecording::close(bool to_disk) {
  flush();
  writer_->close();
  remove_unseen(folder_, all_.lidar, seen_.lidar);
  remove_unseen(folder_, all_.imu, seen_.imu);
  remove_unseen(folder_, all_.barometer, seen_.barometer);
  remove_unseen(folder_, all_.base_barometer, seen_.base_barometer);
  remove_unseen(folder_, all_.wheel, seen_.wheel);
  if (to_disk) {
    sync_folder(folder_);
  }
}

void sync_folder(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder, error)) {
    sync_path(file.path(), 0);
  }
  sync_path(folder, O_DIRECTORY);
}

}  // namespace isobar::recording
