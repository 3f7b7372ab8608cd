// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/protocol.hpp"

#include <algorithm>
#include <cstdio>

#include "drivers/vn100/measurement.hpp"
#include "drivers/vn100/text_line.hpp"
#include "drivers/vn100/text_measurement.hpp"

namespace isobar::vn100 {

namespace {

constexpr int kTextOutput = 6;                     // register: type of the text output, 0: off
constexpr int kBinaryOutput = 75;                  // register: binary output 1
constexpr std::uint16_t kCommonFields = 0x0201;    // TimeStartup, Imu (uncompensated accel and gyro)
constexpr std::uint16_t kCommonAttitude = 0x0010;  // Quaternion
constexpr std::uint16_t kImuFields = 0x0030;       // Temp, Pres
constexpr std::uint8_t kOutputGroups = 0x05;       // common, IMU

constexpr std::uint16_t common_fields(bool attitude) {
  return attitude ? kCommonFields | kCommonAttitude : kCommonFields;
}

std::vector<std::uint8_t> header_of(const Settings& settings) {
  const std::uint16_t common = common_fields(settings.attitude);
  return {kSync,
          kOutputGroups,
          static_cast<std::uint8_t>(common & 0xFFU),
          static_cast<std::uint8_t>(common >> 8U),
          static_cast<std::uint8_t>(kImuFields & 0xFFU),
          static_cast<std::uint8_t>(kImuFields >> 8U)};
}

/// A header in base 16, cut behind four groups.
using Name = std::array<char, 21>;

/// The header in base 16, "FA0510003000": it says the groups and fields of a packet.
Name header_name(std::span<const std::uint8_t> header) {
  Name name{};
  for (std::size_t i = 0; i < header.size() && 2 * i + 2 < name.size(); ++i) {
    std::snprintf(&name.at(2 * i), name.size() - 2 * i, "%02X", unsigned{header[i]});
  }
  return name;
}

const char* lacking(const Measurement& measurement) {
  if (measurement.has_accel) return "angular rate";
  return measurement.has_gyro ? "acceleration with gravity" : "acceleration and angular rate";
}

}  // namespace

Protocol::Protocol(const Settings& settings) : configure_(settings.configure) {
  if (!configure_) return;
  wanted_header_ = header_of(settings);
  add_commands(kTextOutput, "06", "0");
  std::array<char, 48> values{};
  std::snprintf(values.data(), values.size(), "%d,%d,%02X,%04X,%04X", settings.sensor_port,
                kSensorRateHz / settings.rate_hz, unsigned{kOutputGroups},
                unsigned{common_fields(settings.attitude)}, unsigned{kImuFields});
  add_commands(kBinaryOutput, "75", values.data());
}

void Protocol::add_commands(int number, const std::string& name, const std::string& values) {
  commands_.push_back(
      {"$VNWRG," + name, command_line("VNWRG," + name + "," + values), "WRG", number, values});
  commands_.push_back({"$VNRRG," + name, command_line("VNRRG," + name), "RRG", number, values});
}

void Protocol::restart() noexcept {
  parser_.restart();
  done_ = 0;
  measured_ = false;
  packets_measure_ = false;
  heard_[0] = '\0';
}

std::span<const std::uint8_t> Protocol::command() const noexcept {
  if (done_ >= commands_.size()) return {};
  const std::string& line = commands_[done_].line;
  return {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()};
}

const char* Protocol::command_name() const noexcept {
  return done_ < commands_.size() ? commands_[done_].name.c_str() : "";
}

serial::ImuEvent Protocol::next() noexcept {
  serial::ImuEvent event;
  const Frame frame = parser_.next();
  note_unknown_packets();
  if (frame.kind == Frame::Kind::kNone) return event;
  event.kind = serial::ImuEvent::Kind::kOther;
  event.bytes_on_line = frame.bytes_on_line;
  if (frame.kind == Frame::Kind::kBinary) {
    take_packet(frame, event);
  } else {
    take_line(frame, event);
  }
  return event;
}

void Protocol::take_packet(const Frame& frame, serial::ImuEvent& event) noexcept {
  if (done_ < commands_.size()) return;
  const bool wanted = frame.bytes.size() > wanted_header_.size() &&
                      std::equal(wanted_header_.begin(), wanted_header_.end(), frame.bytes.begin());
  if (!wanted) {
    std::snprintf(heard_.data(), heard_.size(), "it sends packets of another output than the one set up");
    return;
  }
  const Measurement measurement = read_packet(frame.bytes);
  if (!measurement.reading.has_imu) {
    const Name header = header_name(frame.bytes.first(measure_packet(frame.bytes).header_bytes));
    std::array<char, 29> name{};
    std::snprintf(name.data(), name.size(), "packets %s", header.data());
    note_incomplete(name.data(), measurement);
  }
  packets_measure_ = packets_measure_ || measurement.reading.has_imu;
  measured_ = measured_ || measurement.reading.has_imu;
  if (!measurement.reading.has_imu && !measurement.reading.has_pressure) return;
  event.kind = serial::ImuEvent::Kind::kReading;
  event.reading = measurement.reading;
  event.has_device_time = measurement.has_time;
  event.device_ns = measurement.time_startup_ns;
}

void Protocol::take_line(const Frame& frame, serial::ImuEvent& event) noexcept {
  if (done_ < commands_.size()) {
    take_answer(frame, event);
  } else if (!configure_) {
    take_text(frame, event);
  }
  const std::optional<Answer> answer = parse_answer(frame.text());
  if (answer && answer->kind == "ERR") event.complaint = error_words(answer->number);
}

void Protocol::take_text(const Frame& frame, serial::ImuEvent& event) noexcept {
  const std::optional<TextMeasurement> text = read_text(frame.text());
  if (!text) {
    if (heard_[0] == '\0') std::snprintf(heard_.data(), heard_.size(), "it sends text without measurements");
    return;
  }
  const InertialReading& reading = text->measurement.reading;
  if (!reading.has_imu) {
    std::array<char, 8> name{};
    std::snprintf(name.data(), name.size(), "$%.5s", text->header.data());
    note_incomplete(name.data(), text->measurement);
  }
  if (packets_measure_ || (!reading.has_imu && !reading.has_pressure)) return;
  measured_ = measured_ || reading.has_imu;
  event.kind = serial::ImuEvent::Kind::kReading;
  event.reading = reading;
}

void Protocol::note_incomplete(const char* name, const Measurement& measurement) noexcept {
  std::snprintf(heard_.data(), heard_.size(), "%.28s: no %.29s; configure = true, or output Imu", name,
                lacking(measurement));
}

void Protocol::note_unknown_packets() noexcept {
  constexpr int kCertain = 8;  // a false sync byte within other data does not repeat its header
  if (heard_[0] != '\0' || parser_.unknown_headers() < kCertain) return;
  std::snprintf(heard_.data(), heard_.size(), "packets %s have fields of unknown length; configure = true",
                header_name(parser_.unknown_header()).data());
}

void Protocol::take_answer(const Frame& frame, serial::ImuEvent& event) noexcept {
  const std::optional<Answer> answer = parse_answer(frame.text());
  if (!answer) return;
  if (answer->kind == "ERR") {
    if (!is_refusal(answer->number)) return;
    std::snprintf(refusal_.data(), refusal_.size(), "refuses %s: error %d, %s", command_name(),
                  answer->number, error_words(answer->number));
    event.kind = serial::ImuEvent::Kind::kRefusal;
    return;
  }
  const Command& command = commands_[done_];
  if (answer->kind != command.kind || answer->number != command.number) return;
  if (begins_with_numbers(answer->values, command.values)) {
    ++done_;
    event.kind = serial::ImuEvent::Kind::kAnswer;
  } else {
    std::snprintf(refusal_.data(), refusal_.size(), "holds %.*s in register %d, not %s",
                  static_cast<int>(std::min<std::size_t>(answer->values.size(), 32)), answer->values.data(),
                  command.number, command.values.c_str());
    event.kind = serial::ImuEvent::Kind::kRefusal;
  }
}

const char* Protocol::heard_instead() const noexcept {
  // Messages of other outputs come between good ones: only what comes alone is told.
  return heard_[0] != '\0' && !measured_ ? heard_.data() : nullptr;
}

}  // namespace isobar::vn100
