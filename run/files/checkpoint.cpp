// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <type_traits>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/tile_store/tile_record.hpp"

namespace isobar::files {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as they are in memory");

namespace {

constexpr std::array<char, 8> kMagic{'I', 'S', 'O', 'B', 'A', 'R', 'C', 'P'};
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kVersionWithoutNames = 1;
constexpr std::size_t kFirstPartBytes = 216;  // all of version 1
// Plausibility: no robot drives that far, no air is that far off.
constexpr double kLargestM = 1e7;
constexpr double kLargestVarianceM2 = 1e8;
constexpr double kLargestSpeedMS = 100.0;
constexpr double kLargestRateRadS = 50.0;
constexpr std::uint32_t kLargestSession = 1'000'000;

/// Content of the file. All padding is explicit.
struct Record {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t length = kCheckpointBytes;  // of the file
  std::uint32_t session = 1;
  std::uint8_t datum_known = 0;
  std::uint8_t step_open = 0;
  std::array<std::uint8_t, HeightDatum::kStations> station_known{};
  std::int64_t stamp_ns = 0;
  std::int64_t clock_ns = 0;
  std::array<double, 3> position_m{};
  std::array<double, 4> quaternion{};  // w x y z
  std::array<double, 3> velocity_m_s{};
  double height_m = 0.0;
  double variance_m2 = 0.0;
  double offset_m = 0.0;
  std::array<double, HeightDatum::kStations> station_offset_log{};
  double overlap = 0.0;
  double residual_rms_m = 0.0;
  double climb_m_s = 0.0;
  std::int64_t datum_stamp_ns = 0;
  double yaw_rate_rad_s = 0.0;
  std::uint8_t ground_moves = 0;
  std::array<std::uint8_t, 7> reserved{};
  std::uint32_t reserved_word = 0;
  std::uint32_t crc = 0;
};
static_assert(sizeof(Record) == kFirstPartBytes && std::is_trivially_copyable_v<Record>);

/// Second part of the file: texts that end with a zero.
struct NamesRecord {
  std::array<std::array<char, kMostStationBytes + 1>, HeightDatum::kStations> stations{};
  std::uint32_t reserved = 0;
  std::uint32_t crc = 0;
};
static_assert(sizeof(Record) + sizeof(NamesRecord) == kCheckpointBytes &&
              std::is_trivially_copyable_v<NamesRecord>);

template <class Part>
std::uint32_t crc_of(const Part& part) {
  return crc32_of(std::as_bytes(std::span(&part, 1)).first(sizeof(part) - sizeof(part.crc)));
}

bool within(double value, double limit) { return std::isfinite(value) && std::abs(value) <= limit; }

template <std::size_t kCount>
bool all_within(const std::array<double, kCount>& values, double limit) {
  return std::all_of(values.begin(), values.end(), [&](double value) { return within(value, limit); });
}

bool are_flags(const Record& record) {
  return record.datum_known <= 1 && record.step_open <= 1 && record.ground_moves <= 1 &&
         record.station_known[0] <= 1 && record.station_known[1] <= 1;
}

std::size_t length_of(std::uint32_t version) {
  return version == kVersionWithoutNames ? kFirstPartBytes : kCheckpointBytes;
}

NamesRecord names_record(const StationNames& names) {
  NamesRecord record;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::copy_n(names[i].begin(), std::min(names[i].size(), kMostStationBytes), record.stations[i].begin());
  }
  record.crc = crc_of(record);
  return record;
}

/// @return false where the checksum or a text is wrong
bool read_names(std::span<const std::byte> bytes, StationNames& names) {
  NamesRecord record;
  std::memcpy(&record, bytes.data(), sizeof(record));
  if (record.crc != crc_of(record)) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& text = record.stations[i];
    const auto end = std::find(text.begin(), text.end(), '\0');
    if (end == text.end()) return false;
    names[i].assign(text.begin(), end);
  }
  return true;
}

const char* broken_rule(const Record& record) {
  if (record.magic != kMagic) return "is no checkpoint of Isobar";
  if (record.version != kVersion && record.version != kVersionWithoutNames) {
    return "is of another version of Isobar";
  }
  if (record.length != length_of(record.version) || record.crc != crc_of(record))
    return "its checksum is wrong";
  const auto& q = record.quaternion;
  const bool plausible =
      record.session >= 1 && record.session <= kLargestSession && are_flags(record) &&
      all_within(record.position_m, kLargestM) && all_within(q, 2.0) &&
      kPlausibleQuaternionNorm.holds(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).norm()) &&
      all_within(record.velocity_m_s, kLargestSpeedMS) && within(record.climb_m_s, kLargestSpeedMS) &&
      within(record.yaw_rate_rad_s, kLargestRateRadS) && within(record.height_m, kLargestM) &&
      within(record.variance_m2, kLargestVarianceM2) && record.variance_m2 >= 0.0 &&
      within(record.offset_m, kLargestM) && within(record.overlap, 1.0) && record.overlap >= 0.0 &&
      within(record.residual_rms_m, 1.0) && record.residual_rms_m >= 0.0 &&
      all_within(record.station_offset_log, 10.0);
  return plausible ? nullptr : "a value is implausible";
}

}  // namespace

CheckpointBytes encode(const Checkpoint& checkpoint) {
  Record record;
  record.session = checkpoint.session;
  record.stamp_ns = checkpoint.stamp_ns;
  record.clock_ns = checkpoint.clock_ns;
  const Eigen::Quaterniond q = Eigen::Quaterniond(checkpoint.T_map_base.linear()).normalized();
  record.quaternion = {q.w(), q.x(), q.y(), q.z()};
  for (std::size_t i = 0; i < 3; ++i) {
    record.position_m[i] = checkpoint.T_map_base.translation()[static_cast<Eigen::Index>(i)];
    record.velocity_m_s[i] = checkpoint.v_map_m_s[static_cast<Eigen::Index>(i)];
  }
  record.yaw_rate_rad_s = checkpoint.yaw_rate_rad_s;
  record.overlap = checkpoint.overlap;
  record.residual_rms_m = checkpoint.residual_rms_m;
  const HeightDatum& datum = checkpoint.datum;
  record.datum_known = datum.known ? 1 : 0;
  record.step_open = datum.step_open ? 1 : 0;
  record.datum_stamp_ns = datum.stamp_ns;
  record.ground_moves = datum.ground_moves ? 1 : 0;
  record.height_m = datum.height_m;
  record.climb_m_s = std::clamp(datum.climb_m_s, -kLargestSpeedMS, kLargestSpeedMS);
  record.variance_m2 = datum.variance_m2;
  record.offset_m = datum.offset_m;
  record.station_offset_log = datum.station_offset_log;
  for (std::size_t i = 0; i < HeightDatum::kStations; ++i) {
    record.station_known[i] = datum.station_known[i] ? 1 : 0;
  }
  record.crc = crc_of(record);
  const NamesRecord names = names_record(checkpoint.stations);
  CheckpointBytes bytes;
  std::memcpy(bytes.data(), &record, sizeof(record));
  std::memcpy(bytes.data() + sizeof(record), &names, sizeof(names));
  return bytes;
}

std::optional<Checkpoint> decode(std::span<const std::byte> bytes, const char*& rule) {
  rule = "has another length than a checkpoint";
  if (bytes.size() != kCheckpointBytes && bytes.size() != kFirstPartBytes) return std::nullopt;
  Record record;
  std::memcpy(&record, bytes.data(), sizeof(record));
  rule = broken_rule(record);
  if (rule == nullptr && bytes.size() != record.length) rule = "has another length than a checkpoint";
  if (rule != nullptr) return std::nullopt;
  Checkpoint checkpoint;
  if (bytes.size() > kFirstPartBytes && !read_names(bytes.subspan(kFirstPartBytes), checkpoint.stations)) {
    rule = "its checksum is wrong";
    return std::nullopt;
  }
  checkpoint.session = record.session;
  checkpoint.stamp_ns = record.stamp_ns;
  checkpoint.clock_ns = record.clock_ns;
  const auto& q = record.quaternion;
  checkpoint.T_map_base.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  checkpoint.T_map_base.translation() = Eigen::Vector3d(record.position_m.data());
  checkpoint.v_map_m_s = Eigen::Vector3d(record.velocity_m_s.data());
  checkpoint.yaw_rate_rad_s = record.yaw_rate_rad_s;
  checkpoint.overlap = record.overlap;
  checkpoint.residual_rms_m = record.residual_rms_m;
  HeightDatum& datum = checkpoint.datum;
  datum.known = record.datum_known == 1;
  datum.step_open = record.step_open == 1;
  datum.stamp_ns = record.datum_stamp_ns;
  datum.ground_moves = record.ground_moves == 1;
  datum.height_m = record.height_m;
  datum.climb_m_s = record.climb_m_s;
  datum.variance_m2 = record.variance_m2;
  datum.offset_m = record.offset_m;
  datum.station_offset_log = record.station_offset_log;
  for (std::size_t i = 0; i < HeightDatum::kStations; ++i) {
    datum.station_known[i] = record.station_known[i] == 1;
  }
  return checkpoint;
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  const CheckpointBytes bytes = encode(checkpoint);
  std::string content(bytes.size(), '\0');
  std::memcpy(content.data(), bytes.data(), bytes.size());
  replace_file(file, content);
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  const std::string content = read_text_file(file, 2 * kCheckpointBytes);
  const char* rule = nullptr;
  auto checkpoint = decode(std::as_bytes(std::span(content)), rule);
  if (!checkpoint) throw DataError(file.string() + ": " + rule);
  return checkpoint;
}

std::filesystem::path run_folder_of(const std::filesystem::path& map_folder) {
  return std::filesystem::absolute(map_folder / "").lexically_normal().parent_path().parent_path();
}

std::optional<Checkpoint> checkpoint_of_map(const std::filesystem::path& map_folder) {
  if (auto own = read_checkpoint(map_folder / kCheckpointFile)) return own;
  auto of_run = read_checkpoint(run_folder_of(map_folder) / kCheckpointFile);
  const std::string name =
      std::filesystem::absolute(map_folder / "").lexically_normal().parent_path().filename();
  const bool of_this = of_run && name == name_of_session(kMapDirectory, of_run->session);
  return of_this ? of_run : std::nullopt;
}

}  // namespace isobar::files
