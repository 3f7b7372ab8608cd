// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/sample_log.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <system_error>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "core/printable_text.hpp"
#include "drivers/vn100/protocol.hpp"
#include "drivers/xsens/protocol.hpp"
#include "run/import/file_bytes.hpp"
#include "run/import/flight_log.hpp"
#include "run/recording/pressure_log.hpp"
#include "run/recording/sample_csv.hpp"

namespace isobar::tools {
namespace {

/// Readings from which on a file counts as the bytes of a sensor.
constexpr std::size_t kLeastReadings = 5;
/// Bytes in which they must be found.
constexpr std::uint64_t kJudgedBytes = std::uint64_t{1} << 20U;

/// The readings of a serial line, one after the other.
class SerialLog {
 public:
  SerialLog(std::unique_ptr<serial::ImuProtocol> protocol, const std::filesystem::path& file)
      : protocol_(std::move(protocol)), in_(file, std::ios::binary) {
    protocol_->restart();
  }
  /// False at the end.
  bool next(serial::ImuEvent& event) {
    for (;;) {
      event = protocol_->next();
      if (event.kind != serial::ImuEvent::Kind::kNone) return true;
      const std::span<std::uint8_t> room = protocol_->room();
      in_.read(reinterpret_cast<char*>(room.data()), static_cast<std::streamsize>(room.size()));
      const auto got = static_cast<std::size_t>(in_.gcount());
      if (got == 0 && ended_) return false;
      if (got == 0) protocol_->give_up_incomplete();
      ended_ = got == 0;
      bytes_ += got;
      protocol_->filled(got);
    }
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const serial::ImuProtocol& protocol() const { return *protocol_; }

 private:
  std::unique_ptr<serial::ImuProtocol> protocol_;
  std::ifstream in_;
  std::uint64_t bytes_ = 0;
  bool ended_ = false;
};

std::unique_ptr<serial::ImuProtocol> make_protocol(const std::string& type) {
  if (type == "VN-100") {
    vn100::Settings settings;
    settings.configure = false;
    return std::make_unique<vn100::Protocol>(settings);
  }
  xsens::Settings settings;
  settings.configure = false;
  return std::make_unique<xsens::Protocol>(settings);
}

/// "VN-100" or "Xsens", by which protocol finds readings; empty: neither does.
std::string serial_type(const std::filesystem::path& file) {
  std::string best;
  std::size_t most = kLeastReadings - 1;
  for (const char* type : {"VN-100", "Xsens"}) {
    SerialLog log(make_protocol(type), file);
    serial::ImuEvent event;
    std::size_t readings = 0;
    while (log.bytes() < kJudgedBytes && log.next(event)) {
      readings += event.kind == serial::ImuEvent::Kind::kReading ? 1 : 0;
    }
    if (readings <= most) continue;
    most = readings;
    best = type;
  }
  return best;
}

void add_reading(const InertialReading& reading, std::int64_t stamp_ns, SampleLog& log) {
  if (reading.has_imu) {
    ImuSample sample = reading.imu;
    sample.stamp_ns = stamp_ns;
    if (implausibility(sample) == nullptr) log.imu.push_back(sample);
  }
  if (reading.has_pressure) {
    PressureSample sample = reading.pressure;
    sample.stamp_ns = stamp_ns;
    if (implausibility(sample) == nullptr) log.pressure.push_back(sample);
  }
}

void read_serial(const std::filesystem::path& file, double rate_hz, SampleLog& log) {
  SerialLog serial(make_protocol(log.type), file);
  const std::int64_t period_ns = serial.protocol().clock_period_ns();
  serial::ImuEvent event;
  std::int64_t last_ns = 0;
  std::int64_t wrapped_ns = 0;
  std::uint64_t readings = 0;
  while (serial.next(event)) {
    if (event.kind != serial::ImuEvent::Kind::kReading) continue;
    std::int64_t stamp_ns = event.device_ns;
    if (!event.has_device_time) {
      if (rate_hz <= 0.0) {
        throw UsageError("--rate: the readings of " + printable(file.string()) +
                         " tell no time; say --rate HZ, as the sensor sent them");
      }
      stamp_ns = std::llround(static_cast<double>(readings) / rate_hz * 1e9);
    } else if (period_ns > 0 && stamp_ns < last_ns - period_ns / 2) {
      wrapped_ns += period_ns;
    }
    last_ns = event.device_ns;
    ++readings;
    add_reading(event.reading, stamp_ns + wrapped_ns, log);
  }
  if (serial.protocol().corrupt() > 0) {
    log.notes.push_back(std::to_string(serial.protocol().corrupt()) +
                        " messages with a wrong check sum are left out");
  }
}

void read_imu_csv(const std::filesystem::path& file, SampleLog& log) {
  text::CsvReader csv = recording::open_imu_csv(file);
  recording::Tally malformed;
  recording::Tally implausible;
  ImuSample sample;
  while (recording::next_sample(csv, sample, malformed, implausible)) log.imu.push_back(sample);
  for (const recording::Tally* tally : {&malformed, &implausible}) {
    if (tally->count > 0) {
      log.notes.push_back(std::to_string(tally->count) +
                          " rows are left out, the first: " + tally->first_message);
    }
  }
}

void read_csv(const std::filesystem::path& file, LogContent wanted, SampleLog& log) {
  log.type = "CSV";
  if (wanted == LogContent::kImu) return read_imu_csv(file, log);
  recording::PressureColumns columns;
  columns.needs_temperature = false;
  recording::PressureLog pressure = recording::read_pressure_log(file, columns);
  log.pressure = std::move(pressure.samples);
  log.notes = std::move(pressure.notes);
}

}  // namespace

void SampleLog::shift(std::int64_t by_ns) {
  for (ImuSample& sample : imu) sample.stamp_ns += by_ns;
  for (PressureSample& sample : pressure) sample.stamp_ns += by_ns;
}

bool is_sample_log(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  return imports::is_flight_log(file) || !serial_type(file).empty();
}

SampleLog read_sample_log(const std::filesystem::path& file, LogContent wanted, double rate_hz) {
  const imports::FileBytes readable(file);  // says why it is not
  SampleLog log;
  if (imports::is_flight_log(file)) {
    imports::FlightLog flight = imports::read_flight_log(file);
    log.type = flight.type;
    log.imu = std::move(flight.imu);
    log.pressure = std::move(flight.pressure);
    log.has_date = flight.utc_offset_ns.has_value();
    if (flight.damage.count > 0) log.notes.push_back(flight.damage.first_message);
  } else if (log.type = serial_type(file); !log.type.empty()) {
    read_serial(file, rate_hz, log);
  } else {
    read_csv(file, wanted, log);
    constexpr std::int64_t kYear2000Ns = 946'684'800'000'000'000;
    const std::int64_t first_ns = !log.imu.empty()        ? log.imu.front().stamp_ns
                                  : !log.pressure.empty() ? log.pressure.front().stamp_ns
                                                          : 0;
    log.has_date = first_ns > kYear2000Ns;
  }
  if (log.imu.empty() && log.pressure.empty()) {
    throw DataError(file.string() + ": " + log.type + ": holds no usable sample of an IMU or a barometer");
  }
  return log;
}

}  // namespace isobar::tools
