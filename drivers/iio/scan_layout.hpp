// SPDX-License-Identifier: BSD-3-Clause
// Scans of the kernel's industrial I/O buffer: enabled channels in the order of their index, each at a multiple
// of its own size, the whole at a multiple of the largest (Linux, Documentation/driver-api/iio/buffers.rst and
// ABI/testing/sysfs-bus-iio).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace isobar::iio {

/// Form of a channel's value, "le:s12/16>>4": byte order, sign, bits of value and storage, shift.
struct ElementType {
  bool big_endian = false;
  bool is_signed = false;
  int bits = 0;           ///< 1 … 64
  int storage_bytes = 0;  ///< 1, 2, 4 or 8
  int shift = 0;

  /// @param bytes of storage_bytes
  [[nodiscard]] std::int64_t value(std::span<const std::uint8_t> bytes) const noexcept;
};
/// Nothing: malformed, or a channel of several values ("X2").
[[nodiscard]] std::optional<ElementType> parse_element_type(std::string_view text) noexcept;

/// Channels that an IMU's scan holds.
inline constexpr std::array<std::string_view, 7> kImuChannels{
    "in_anglvel_x", "in_anglvel_y", "in_anglvel_z", "in_accel_x", "in_accel_y", "in_accel_z", "in_timestamp"};
inline constexpr std::size_t kTimestampChannel = 6;

class ScanLayout {
 public:
  struct Element {
    bool used = false;
    int index = 0;
    ElementType type;
    std::size_t at = 0;  ///< byte in the scan
  };

  /// @param channel of kImuChannels
  void add(std::size_t channel, int index, const ElementType& type) noexcept {
    elements_[channel] = {true, index, type, 0};
  }
  /// Computes the places. False when two channels have one index.
  bool finish() noexcept;
  [[nodiscard]] std::size_t scan_bytes() const noexcept { return scan_bytes_; }
  [[nodiscard]] bool has(std::size_t channel) const noexcept { return elements_[channel].used; }
  [[nodiscard]] std::int64_t value(std::span<const std::uint8_t> scan, std::size_t channel) const noexcept;

 private:
  std::array<Element, kImuChannels.size()> elements_{};
  std::size_t scan_bytes_ = 0;
};

}  // namespace isobar::iio
