// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/protocol.hpp"

#include <algorithm>
#include <cstdio>

namespace isobar::xsens {

namespace {

/// Highest rate of the barometers [Hz].
constexpr int kPressureRateHz = 50;
constexpr std::size_t kOutputBytes = 4;  // identifier and rate

std::vector<Output> outputs_of(const Settings& settings) {
  const auto rate = static_cast<std::uint16_t>(settings.rate_hz);
  const auto id = [](Item item) { return static_cast<std::uint16_t>(item); };  // 32-bit floats, east-north-up
  std::vector<Output> outputs{{id(Item::kPacketCounter), kEveryMessage, "packet counter"},
                              {id(Item::kSampleTimeFine), kEveryMessage, "sample time"},
                              {id(Item::kAcceleration), rate, "acceleration"},
                              {id(Item::kRateOfTurn), rate, "rate of turn"}};
  if (settings.attitude) outputs.push_back({id(Item::kQuaternion), rate, "quaternion"});
  if (settings.pressure) {
    const auto slow = static_cast<std::uint16_t>(std::min(settings.rate_hz, kPressureRateHz));
    outputs.push_back({id(Item::kPressure), slow, "pressure", true});
    outputs.push_back({id(Item::kTemperature), 1, "temperature", true});
  }
  return outputs;
}

std::vector<std::uint8_t> output_command(const std::vector<Output>& outputs, bool with_optional) {
  std::vector<std::uint8_t> data;
  for (const Output& output : outputs) {
    if (output.optional && !with_optional) continue;
    for (const std::uint16_t value : {output.id, output.rate_hz}) {
      data.push_back(static_cast<std::uint8_t>(value >> 8U));
      data.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    }
  }
  return make_message(Id::kSetOutput, data);
}

/// Rate at which an acknowledged configuration has an output; 0: not at all.
int rate_in(std::span<const std::uint8_t> held, std::uint16_t id) {
  for (std::size_t at = 0; at + kOutputBytes <= held.size(); at += kOutputBytes) {
    if ((held[at] << 8U | held[at + 1]) == id) return held[at + 2] << 8U | held[at + 3];
  }
  return 0;
}

}  // namespace

Protocol::Protocol(const Settings& settings)
    : configure_(settings.configure),
      outputs_(outputs_of(settings)),
      go_to_config_(make_message(Id::kGoToConfig, {})),
      go_to_measurement_(make_message(Id::kGoToMeasurement, {})),
      read_output_(make_message(Id::kSetOutput, {})),  // without data: a request
      set_output_(output_command(outputs_, true)),
      set_output_without_(output_command(outputs_, false)) {}

void Protocol::restart() noexcept {
  parser_.restart();
  reader_ = SampleReader();
  stage_ = configure_ ? Stage::kGoToConfig : Stage::kDone;
  without_optional_ = false;
  measured_ = false;
  heard_[0] = '\0';
}

std::span<const std::uint8_t> Protocol::command() const noexcept {
  switch (stage_) {
    case Stage::kGoToConfig:
      return go_to_config_;
    case Stage::kReadOutput:
      return read_output_;
    case Stage::kSetOutput:
      return without_optional_ ? set_output_without_ : set_output_;
    case Stage::kGoToMeasurement:
      return go_to_measurement_;
    case Stage::kDone:
      break;
  }
  return {};
}

const char* Protocol::command_name() const noexcept {
  switch (stage_) {
    case Stage::kGoToConfig:
      return "GoToConfig";
    case Stage::kReadOutput:
      return "ReqOutputConfiguration";
    case Stage::kSetOutput:
      return "SetOutputConfiguration";
    case Stage::kGoToMeasurement:
      return "GoToMeasurement";
    case Stage::kDone:
      break;
  }
  return "";
}

serial::ImuEvent Protocol::next() noexcept {
  serial::ImuEvent event;
  const Frame frame = parser_.next();
  if (!frame.found) return event;
  event.kind = serial::ImuEvent::Kind::kOther;
  event.bytes_on_line = frame.bytes_on_line;
  switch (frame.id) {
    case Id::kData:
      take_data(frame, event);
      break;
    case Id::kLegacyData:
      if (stage_ == Stage::kDone) {
        std::snprintf(heard_.data(), heard_.size(),
                      "it sends MTData of old firmware: configure = true sets MTData2");
      }
      break;
    case Id::kError:
      take_error(frame, event);
      break;
    case Id::kGoToConfigAck:
      answer(Stage::kGoToConfig, Stage::kReadOutput, event);
      break;
    case Id::kSetOutputAck:
      if (stage_ == Stage::kSetOutput) {
        event.kind = check_outputs(frame.data);
      } else {
        answer(Stage::kReadOutput, as_wanted(frame.data) ? Stage::kGoToMeasurement : Stage::kSetOutput,
               event);
      }
      break;
    case Id::kGoToMeasurementAck:
      answer(Stage::kGoToMeasurement, Stage::kDone, event);
      break;
    default:
      break;
  }
  return event;
}

void Protocol::answer(Stage of, Stage next, serial::ImuEvent& event) noexcept {
  if (stage_ != of) return;
  stage_ = next;
  event.kind = serial::ImuEvent::Kind::kAnswer;
}

void Protocol::take_data(const Frame& frame, serial::ImuEvent& event) noexcept {
  if (stage_ != Stage::kDone) return;
  const Measurement measurement = reader_.read(frame.data);
  measured_ = measured_ || measurement.reading.has_imu;
  if (measurement.lacking != nullptr) {
    std::snprintf(heard_.data(), heard_.size(), "its data lack %s", measurement.lacking);
  }
  if (!measurement.reading.has_imu && !measurement.reading.has_pressure) return;
  event.kind = serial::ImuEvent::Kind::kReading;
  event.reading = measurement.reading;
  event.has_device_time = measurement.time.has_value();
  event.device_ns = kTickNs * static_cast<std::int64_t>(measurement.time.value_or(0));
}

void Protocol::take_error(const Frame& frame, serial::ImuEvent& event) noexcept {
  const int code = frame.data.empty() ? 0 : frame.data[0];
  const char* words = error_words(code);
  event.complaint = words != nullptr ? words : "an error of an unknown code";
  if (stage_ == Stage::kDone) return;
  if (stage_ == Stage::kReadOutput) {
    answer(Stage::kReadOutput, Stage::kSetOutput, event);  // older firmware cannot be asked
    return;
  }
  if (stage_ == Stage::kSetOutput && !without_optional_) {
    without_optional_ = true;  // a model without a barometer
    event.kind = serial::ImuEvent::Kind::kAnswer;
    return;
  }
  std::snprintf(refusal_.data(), refusal_.size(), "refuses %s: error %d, %s", command_name(), code,
                event.complaint);
  event.kind = serial::ImuEvent::Kind::kRefusal;
}

bool Protocol::as_wanted(std::span<const std::uint8_t> held) const noexcept {
  constexpr std::size_t kFrame = 5;  // four bytes before the data, the checksum behind
  const auto equals = [held](const std::vector<std::uint8_t>& command) {
    return held.size() + kFrame == command.size() &&
           std::equal(held.begin(), held.end(), command.begin() + 4);
  };
  return equals(set_output_) || equals(set_output_without_);
}

serial::ImuEvent::Kind Protocol::check_outputs(std::span<const std::uint8_t> held) noexcept {
  for (const Output& output : outputs_) {
    const int rate_hz = rate_in(held, output.id);
    const bool as_asked = rate_hz == output.rate_hz || (output.rate_hz == kEveryMessage && rate_hz > 0);
    if (as_asked || output.optional) continue;
    if (rate_hz == 0) {
      std::snprintf(refusal_.data(), refusal_.size(), "this model has no output %s", output.name);
    } else {
      std::snprintf(refusal_.data(), refusal_.size(), "sends the %s with %d Hz, not %d", output.name, rate_hz,
                    static_cast<int>(output.rate_hz));
    }
    return serial::ImuEvent::Kind::kRefusal;
  }
  stage_ = Stage::kGoToMeasurement;
  return serial::ImuEvent::Kind::kAnswer;
}

const char* Protocol::heard_instead() const noexcept {
  // Messages of a lower rate come between good ones: only what comes alone is told.
  return heard_[0] != '\0' && !measured_ ? heard_.data() : nullptr;
}

}  // namespace isobar::xsens
