// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/import/byte_cursor.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/flight_log.hpp"

namespace isobar::imports {
namespace {

constexpr std::uint8_t kHead1 = 0xa3;
constexpr std::uint8_t kHead2 = 0x95;
constexpr std::uint8_t kFormatType = 0x80;
constexpr std::size_t kHeadBytes = 3;
constexpr std::size_t kFormatBytes = 89;
/// 6 January 1980 in seconds since 1970, and the leap seconds since (2017 on).
constexpr double kGpsEpochS = 315'964'800.0;
constexpr double kLeapSeconds = 18.0;

/// Bytes of a value by its letter (ArduPilot, libraries/AP_Logger/LogStructure.h); 0: unknown.
std::size_t size_of_letter(char letter) {
  if (std::string_view("bBM").find(letter) != std::string_view::npos) return 1;
  if (std::string_view("hHcCg").find(letter) != std::string_view::npos) return 2;
  if (std::string_view("iIfneEL").find(letter) != std::string_view::npos) return 4;
  if (std::string_view("dqQ").find(letter) != std::string_view::npos) return 8;
  return letter == 'N' ? 16 : letter == 'Z' || letter == 'a' ? 64 : 0;
}

struct DataflashFormat {
  std::string name;
  std::size_t length = 0;  // of a whole message
  std::string letters;
  std::vector<std::string> columns;
};

std::string text_of(std::span<const std::uint8_t> bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  return {bytes.begin(), end};
}

DataflashFormat parse_format_message(ByteCursor& cursor) {
  DataflashFormat format;
  format.length = cursor.get<std::uint8_t>();
  format.name = text_of(cursor.take(4));
  format.letters = text_of(cursor.take(16));
  const std::string columns = text_of(cursor.take(64));
  for (std::size_t begin = 0; begin < columns.size();) {
    const std::size_t end = std::min(columns.find(',', begin), columns.size());
    format.columns.push_back(columns.substr(begin, end - begin));
    begin = end + 1;
  }
  return format;
}

double number_of(char letter, ByteCursor cursor) {
  switch (letter) {
    case 'b':
      return cursor.get<std::int8_t>();
    case 'B':
    case 'M':
      return cursor.get<std::uint8_t>();
    case 'h':
      return cursor.get<std::int16_t>();
    case 'H':
      return cursor.get<std::uint16_t>();
    case 'c':
      return cursor.get<std::int16_t>() / 100.0;
    case 'C':
      return cursor.get<std::uint16_t>() / 100.0;
    case 'i':
    case 'L':
      return cursor.get<std::int32_t>();
    case 'I':
      return cursor.get<std::uint32_t>();
    case 'e':
      return cursor.get<std::int32_t>() / 100.0;
    case 'E':
      return cursor.get<std::uint32_t>() / 100.0;
    case 'f':
      return static_cast<double>(cursor.get<float>());
    case 'd':
      return cursor.get<double>();
    case 'q':
      return static_cast<double>(cursor.get<std::int64_t>());
    case 'Q':
      return static_cast<double>(cursor.get<std::uint64_t>());
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

/// The columns of a message by name.
class Row {
 public:
  Row(const DataflashFormat& format, std::span<const std::uint8_t> payload)
      : format_(format), payload_(payload) {}
  /// NaN where there is no such column.
  [[nodiscard]] double at(std::string_view column) const {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < format_.letters.size() && i < format_.columns.size(); ++i) {
      const std::size_t size = size_of_letter(format_.letters[i]);
      if (size == 0 || offset + size > payload_.size()) break;
      if (format_.columns[i] == column)
        return number_of(format_.letters[i], ByteCursor(payload_.subspan(offset, size)));
      offset += size;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const DataflashFormat& format_;
  std::span<const std::uint8_t> payload_;
};

void take_row(const std::string& name, const Row& row, FlightLog& log) {
  const double time_us = row.at("TimeUS");
  if (!(time_us >= 0.0 && time_us < 4e15)) return;
  const std::int64_t stamp_ns = std::llround(time_us) * 1'000;
  const double instance = row.at("I");
  if (instance > 0.0) return;  // of several sensors the first
  if (name == "IMU") {
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    sample.gyro_rad_s = {row.at("GyrX"), -row.at("GyrY"), -row.at("GyrZ")};
    sample.accel_m_s2 = {row.at("AccX"), -row.at("AccY"), -row.at("AccZ")};
    if (implausibility(sample) == nullptr) log.imu.push_back(sample);
  } else if (name == "BARO") {
    PressureSample sample;
    sample.stamp_ns = stamp_ns;
    sample.pressure_pa = row.at("Press");
    const double temperature_c = row.at("Temp");
    sample.temperature_c = kPlausibleTemperatureC.holds(temperature_c)
                               ? temperature_c
                               : std::numeric_limits<double>::quiet_NaN();
    if (implausibility(sample) == nullptr) log.pressure.push_back(sample);
  } else if (name == "GPS" && row.at("Status") >= 3.0 && row.at("GWk") > 1000.0) {
    const double utc_s = kGpsEpochS - kLeapSeconds + row.at("GWk") * 604'800.0 + row.at("GMS") * 1e-3;
    log.utc_offset_ns = (std::llround(utc_s * 1e3) * 1'000'000) - stamp_ns;
  }
}

}  // namespace

FlightLog read_dataflash(const std::filesystem::path& file) {
  FlightLog log;
  log.type = "dataflash";
  FileBytes bytes(file);
  std::vector<std::uint8_t> all;
  if (!bytes.read(bytes.size(), all)) throw DataError(file.string() + ": is longer than 512 MiB");
  std::map<std::uint8_t, DataflashFormat> formats;
  for (std::size_t at = 0; at + kHeadBytes <= all.size();) {
    const std::uint8_t type = all[at + 2];
    const auto format = formats.find(type);
    const bool is_head = all[at] == kHead1 && all[at + 1] == kHead2;
    const std::size_t length = !is_head                  ? 0
                               : type == kFormatType     ? kFormatBytes
                               : format == formats.end() ? 0
                                                         : format->second.length;
    if (length < kHeadBytes || at + length > all.size()) {
      log.damage.add(
          [&] { return bytes.place(at) + "is no message; what follows is searched for the next one"; });
      ++at;
      continue;
    }
    const auto payload = std::span<const std::uint8_t>(all).subspan(at + kHeadBytes, length - kHeadBytes);
    if (type == kFormatType) {
      ByteCursor cursor(payload);
      const auto of = cursor.get<std::uint8_t>();
      formats[of] = parse_format_message(cursor);
    } else {
      take_row(format->second.name, Row(format->second, payload), log);
    }
    at += length;
  }
  return log;
}

}  // namespace isobar::imports
