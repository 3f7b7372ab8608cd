// SPDX-License-Identifier: BSD-3-Clause
// Writes MTData2 messages item by item.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace isobar::test {

class MessageWriter {
 public:
  MessageWriter& item(std::uint16_t id, const std::vector<std::uint8_t>& data) {
    put(id, 2);
    put(data.size(), 1);
    data_.insert(data_.end(), data.begin(), data.end());
    return *this;
  }
  MessageWriter& integer(std::uint16_t id, std::uint64_t value, int bytes) {
    put(id, 2);
    put(static_cast<std::uint64_t>(bytes), 1);
    put(value, bytes);
    return *this;
  }
  /// Numbers in the precision of the identifier's lowest two bits.
  MessageWriter& numbers(std::uint16_t id, std::initializer_list<double> values) {
    constexpr std::uint64_t kBytes[4] = {4, 4, 6, 8};  // NOLINT(modernize-avoid-c-arrays)
    put(id, 2);
    put(kBytes[id & 3U] * values.size(), 1);
    for (const double value : values) number(id & 3U, value);
    return *this;
  }
  [[nodiscard]] const std::vector<std::uint8_t>& data() const { return data_; }
  /// The whole message, with the extended length if `extended` or if it is needed.
  [[nodiscard]] std::vector<std::uint8_t> finish(bool extended = false) const {
    std::vector<std::uint8_t> message;
    message.reserve(data_.size() + 7);
    for (const std::uint8_t byte : {0xFA, 0xFF, 0x36}) message.push_back(byte);
    if (extended || data_.size() >= 255) {
      message.push_back(0xFF);
      message.push_back(static_cast<std::uint8_t>(data_.size() >> 8U));
    }
    message.push_back(static_cast<std::uint8_t>(data_.size() & 0xFFU));
    message.insert(message.end(), data_.begin(), data_.end());
    unsigned sum = 0;
    for (std::size_t i = 1; i < message.size(); ++i) sum += message[i];
    message.push_back(static_cast<std::uint8_t>(0x100U - (sum & 0xFFU)));
    return message;
  }

 private:
  void put(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) data_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  }
  void number(unsigned precision, double value) {
    if (precision == 0) put(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
    if (precision == 1) put(static_cast<std::uint32_t>(std::llround(value * 1048576.0)), 4);
    if (precision == 2) {
      const auto fixed = static_cast<std::uint64_t>(std::llround(value * 4294967296.0));
      put(fixed & 0xFFFFFFFFU, 4);
      put(fixed >> 32U & 0xFFFFU, 2);
    }
    if (precision == 3) put(std::bit_cast<std::uint64_t>(value), 8);
  }

  std::vector<std::uint8_t> data_;
};

/// A message of the output that the driver sets up.
inline std::vector<std::uint8_t> own_message(std::uint16_t counter, std::uint32_t ticks, double rate_z = 0.25,
                                             int pressure_pa = 0) {
  MessageWriter writer;
  writer.integer(0x1020, counter, 2).integer(0x1060, ticks, 4);
  writer.numbers(0x4020, {0.1, -0.2, 9.8}).numbers(0x8020, {0.01, -0.02, rate_z});
  if (pressure_pa > 0) writer.integer(0x3010, static_cast<std::uint64_t>(pressure_pa), 4);
  return writer.finish();
}

}  // namespace isobar::test
