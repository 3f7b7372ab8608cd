// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/protocol.hpp"

#include <algorithm>
#include <cstdio>

#include "drivers/vn100/measurement.hpp"
#include "drivers/vn100/text_line.hpp"

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
  heard_text_ = false;
  heard_other_packets_ = false;
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
  const Measurement measurement = wanted ? read_packet(frame.bytes) : Measurement{};
  if (!measurement.reading.has_imu && !measurement.reading.has_pressure) {
    heard_other_packets_ = true;
    return;
  }
  if (!measurement.reading.has_imu) heard_other_packets_ = true;
  event.kind = serial::ImuEvent::Kind::kReading;
  event.reading = measurement.reading;
  event.has_device_time = measurement.has_time;
  event.device_ns = measurement.time_startup_ns;
}

void Protocol::take_line(const Frame& frame, serial::ImuEvent& event) noexcept {
  if (done_ >= commands_.size()) heard_text_ = true;
  const std::optional<Answer> answer = parse_answer(frame.text());
  if (!answer) return;
  if (answer->kind == "ERR") {
    event.complaint = error_words(answer->number);
    if (done_ >= commands_.size() || !is_refusal(answer->number)) return;
    std::snprintf(refusal_.data(), refusal_.size(), "refuses %s: error %d, %s", command_name(),
                  answer->number, error_words(answer->number));
    event.kind = serial::ImuEvent::Kind::kRefusal;
    return;
  }
  if (done_ >= commands_.size()) return;
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
  if (heard_other_packets_)
    return "it sends packets without acceleration and angular rate, or of another output";
  if (heard_text_) return "it sends text, no binary output";
  return nullptr;
}

}  // namespace isobar::vn100
