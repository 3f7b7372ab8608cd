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

constexpr std::string_view kUlogMagic("\x55\x4c\x6f\x67\x01\x12\x35", 7);
constexpr std::size_t kUlogHeaderBytes = 16;

struct UlogType {
  std::string_view name;
  std::size_t size;
};
constexpr std::array kUlogTypes{UlogType{"int8_t", 1},   UlogType{"uint8_t", 1},  UlogType{"int16_t", 2},
                                UlogType{"uint16_t", 2}, UlogType{"int32_t", 4},  UlogType{"uint32_t", 4},
                                UlogType{"int64_t", 8},  UlogType{"uint64_t", 8}, UlogType{"float", 4},
                                UlogType{"double", 8},   UlogType{"bool", 1},     UlogType{"char", 1}};

struct UlogField {
  std::string type;
  std::size_t offset = 0;
  std::size_t count = 1;
};
using UlogFormat = std::map<std::string, UlogField>;

/// "uint64_t timestamp;float[3] gyro_rad;": fields up to the first of a nested type.
UlogFormat parse_format(std::string_view text) {
  UlogFormat format;
  std::size_t offset = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view field = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t blank = field.find(' ');
    if (blank == std::string_view::npos) break;
    std::string_view type = field.substr(0, blank);
    std::size_t count = 1;
    if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
      count = static_cast<std::size_t>(std::atoi(std::string(type.substr(bracket + 1)).c_str()));
      type = type.substr(0, bracket);
    }
    const auto known = std::find_if(kUlogTypes.begin(), kUlogTypes.end(),
                                    [&](const UlogType& candidate) { return candidate.name == type; });
    if (known == kUlogTypes.end() || count == 0 || count > 65'535) break;
    format[std::string(field.substr(blank + 1))] = {std::string(type), offset, count};
    offset += known->size * count;
  }
  return format;
}

/// A value of a field of a data message; NaN where it has none.
double value_of(const UlogFormat& format, std::span<const std::uint8_t> data, const std::string& name,
                std::size_t index = 0) {
  const auto field = format.find(name);
  if (field == format.end() || index >= field->second.count) return std::numeric_limits<double>::quiet_NaN();
  const std::string& type = field->second.type;
  const std::size_t size = type == "double" || type.ends_with("64_t") ? 8 : 4;
  const std::size_t at = field->second.offset + index * size;
  if (at + size > data.size()) return std::numeric_limits<double>::quiet_NaN();
  ByteCursor cursor(data.subspan(at));
  if (type == "float") return static_cast<double>(cursor.get<float>());
  if (type == "double") return cursor.get<double>();
  if (type == "uint64_t") return static_cast<double>(cursor.get<std::uint64_t>());
  if (type == "int64_t") return static_cast<double>(cursor.get<std::int64_t>());
  if (type == "int32_t") return static_cast<double>(cursor.get<std::int32_t>());
  return type == "uint32_t" ? static_cast<double>(cursor.get<std::uint32_t>())
                            : std::numeric_limits<double>::quiet_NaN();
}

class UlogReader {
 public:
  explicit UlogReader(FlightLog& log) : log_(log) {}

  void take(char kind, std::span<const std::uint8_t> content) {
    if (kind == 'F') {
      const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
      const std::size_t colon = text.find(':');
      if (colon != std::string_view::npos) {
        formats_[std::string(text.substr(0, colon))] = parse_format(text.substr(colon + 1));
      }
    } else if (kind == 'A') {
      ByteCursor cursor(content);
      const auto instance = cursor.get<std::uint8_t>();
      const auto id = cursor.get<std::uint16_t>();
      const auto name = cursor.take(cursor.left());
      if (instance == 0) topics_[id] = std::string(name.begin(), name.end());
    } else if (kind == 'D') {
      ByteCursor cursor(content);
      const auto topic = topics_.find(cursor.get<std::uint16_t>());
      if (topic != topics_.end()) take_data(topic->second, cursor.take(cursor.left()));
    }
  }
  /// The better of two barometers' topics.
  void finish() { log_.pressure = air_data_.empty() ? std::move(baro_) : std::move(air_data_); }

 private:
  void take_data(const std::string& topic, std::span<const std::uint8_t> data) {
    const UlogFormat& format = formats_[topic];
    const double time_us = value_of(format, data, "timestamp");
    if (!(time_us >= 0.0 && time_us < 4e15)) return;
    const std::int64_t stamp_ns = std::llround(time_us) * 1'000;
    const auto get = [&](const char* name, std::size_t index = 0) {
      return value_of(format, data, name, index);
    };
    if (topic == "sensor_combined") {
      ImuSample sample;
      sample.stamp_ns = stamp_ns;
      sample.gyro_rad_s = {get("gyro_rad"), -get("gyro_rad", 1), -get("gyro_rad", 2)};
      sample.accel_m_s2 = {get("accelerometer_m_s2"), -get("accelerometer_m_s2", 1),
                           -get("accelerometer_m_s2", 2)};
      if (implausibility(sample) == nullptr) log_.imu.push_back(sample);
    } else if (topic == "vehicle_air_data") {
      add_pressure(stamp_ns, get("baro_pressure_pa"), get("baro_temp_celcius"), air_data_);
    } else if (topic == "sensor_baro") {
      // Pa; up to PX4 1.12 in hPa.
      const double pressure = get("pressure");
      add_pressure(stamp_ns, pressure < 2'000.0 ? pressure * 100.0 : pressure, get("temperature"), baro_);
    } else if (topic == "vehicle_gps_position" || topic == "sensor_gps") {
      const double utc_us = get("time_utc_usec");
      if (utc_us > 1e15 && utc_us < 4e15) log_.utc_offset_ns = std::llround(utc_us - time_us) * 1'000;
    }
  }
  static void add_pressure(std::int64_t stamp_ns, double pressure_pa, double temperature_c,
                           std::vector<PressureSample>& to) {
    PressureSample sample;
    sample.stamp_ns = stamp_ns;
    sample.pressure_pa = pressure_pa;
    sample.temperature_c = kPlausibleTemperatureC.holds(temperature_c)
                               ? temperature_c
                               : std::numeric_limits<double>::quiet_NaN();
    if (implausibility(sample) == nullptr) to.push_back(sample);
  }

  FlightLog& log_;
  std::map<std::string, UlogFormat> formats_;
  std::map<std::uint16_t, std::string> topics_;
  std::vector<PressureSample> air_data_;
  std::vector<PressureSample> baro_;
};

}  // namespace

FlightLog read_ulog(const std::filesystem::path& file) {
  FlightLog log;
  log.type = "ULog";
  FileBytes bytes(file);
  if (!bytes.skip(kUlogHeaderBytes)) throw DataError(file.string() + ": is no ULog");
  UlogReader reader(log);
  std::array<std::uint8_t, 3> head{};
  std::vector<std::uint8_t> content;
  while (bytes.left() > 0) {
    const std::uint64_t at = bytes.position();
    if (!bytes.read(head) || !bytes.read(ByteCursor(head).get<std::uint16_t>(), content)) {
      log.damage.add([&] { return bytes.place(at) + "a message ends beyond the file, which is cut there"; });
      break;
    }
    reader.take(static_cast<char>(head[2]), content);
  }
  reader.finish();
  return log;
}

bool is_flight_log(const std::filesystem::path& file) {
  const std::string head = head_of(file, kUlogMagic.size());
  return head == kUlogMagic || head.starts_with("\xa3\x95\x80");
}

FlightLog read_flight_log(const std::filesystem::path& file) {
  if (!is_flight_log(file)) throw DataError(file.string() + ": is no ULog and no dataflash log");
  FlightLog log = head_of(file, kUlogMagic.size()) == kUlogMagic ? read_ulog(file) : read_dataflash(file);
  if (!log.utc_offset_ns) return log;
  for (ImuSample& sample : log.imu) sample.stamp_ns += *log.utc_offset_ns;
  for (PressureSample& sample : log.pressure) sample.stamp_ns += *log.utc_offset_ns;
  return log;
}

}  // namespace isobar::imports
