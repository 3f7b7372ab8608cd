// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/message.hpp"

#include "drivers/xsens/data_items.hpp"

namespace isobar::xsens {

namespace {

/// In the length byte: the length follows in two bytes.
constexpr std::uint8_t kExtended = 0xFF;
/// Longest data of the protocol.
constexpr std::size_t kMaxDataBytes = 2048;

bool is_used(std::uint8_t id) {
  switch (static_cast<Id>(id)) {
    case Id::kGoToMeasurementAck:
    case Id::kGoToConfigAck:
    case Id::kData:
    case Id::kLegacyData:
    case Id::kWakeUp:
    case Id::kError:
    case Id::kSetOutputAck:
      return true;
    default:
      return false;
  }
}

/// All bytes from the address to the checksum add up to 0 modulo 256.
std::uint8_t sum_of(std::span<const std::uint8_t> bytes) {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum + byte);
  return sum;
}

}  // namespace

MessageSize measure_message(std::span<const std::uint8_t> bytes) noexcept {
  MessageSize size;
  constexpr std::size_t kShortHeader = 4;
  constexpr std::size_t kLongHeader = 6;
  if (bytes.empty() || bytes[0] != kPreamble) return size;
  if (bytes.size() > 1 && bytes[1] != kMaster) return size;
  if (bytes.size() > 2 && !is_used(bytes[2])) return size;
  size.form = MessageForm::kIncomplete;
  if (bytes.size() < kShortHeader) return size;
  size.header_bytes = kShortHeader;
  size.data_bytes = bytes[3];
  if (bytes[3] == kExtended) {
    if (bytes.size() < kLongHeader) return size;
    size.header_bytes = kLongHeader;
    size.data_bytes = static_cast<std::size_t>(bytes[4]) << 8U | bytes[5];
  }
  if (size.data_bytes > kMaxDataBytes) {
    size.form = MessageForm::kNone;
    return size;
  }
  if (bytes.size() < size.bytes()) return size;
  const bool holds = sum_of(bytes.subspan(1, size.bytes() - 1)) == 0;
  const bool is_data = static_cast<Id>(bytes[2]) == Id::kData;
  if (!holds) {
    size.form = is_data ? MessageForm::kCorrupt : MessageForm::kNone;
    return size;
  }
  // The checksum has eight bits only: of 256 false starts one passes it, but not this.
  const bool sound = !is_data || items_fill(bytes.subspan(size.header_bytes, size.data_bytes));
  size.form = sound ? MessageForm::kWhole : MessageForm::kNone;
  return size;
}

std::vector<std::uint8_t> make_message(Id id, std::span<const std::uint8_t> data) {
  std::vector<std::uint8_t> message;
  message.reserve(data.size() + 5);
  for (const std::uint8_t byte :
       {kPreamble, kMaster, static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(data.size())}) {
    message.push_back(byte);
  }
  message.insert(message.end(), data.begin(), data.end());
  const std::uint8_t sum = sum_of(std::span(message).subspan(1));
  message.push_back(static_cast<std::uint8_t>(0x100U - sum));
  return message;
}

const char* error_words(int code) noexcept {
  switch (code) {
    case 3:
      return "period outside the valid range";
    case 4:
      return "invalid message";
    case 30:
      return "timer overflow: too much output";
    case 32:
      return "baud rate outside the valid range";
    case 33:
      return "invalid parameter";
    case 35:
    case 36:
      return "transmit buffer overflow: baud rate too low";
    case 40:
      return "fault of the device";
    case 41:
      return "more data than the line can carry";
    case 42:
      return "sample buffer overflow";
    default:
      return nullptr;
  }
}

}  // namespace isobar::xsens
