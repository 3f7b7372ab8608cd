// SPDX-License-Identifier: BSD-3-Clause
// Items of an MTData2 message: data identifier (16 bits), length, data (MT0101P, section "MTData2").
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace isobar::xsens {

/// Kinds of items that are used here: the identifier without its lowest four bits.
enum class Item : std::uint16_t {
  kTemperature = 0x0810,
  kUtcTime = 0x1010,
  kPacketCounter = 0x1020,
  kSampleTimeFine = 0x1060,
  kSampleTimeCoarse = 0x1070,
  kQuaternion = 0x2010,
  kRotationMatrix = 0x2020,
  kEulerAngles = 0x2030,
  kPressure = 0x3010,
  kVelocityIncrement = 0x4010,  ///< "DeltaV"
  kAcceleration = 0x4020,
  kFreeAcceleration = 0x4030,  ///< without gravity, in the world
  kAccelerationHighRate = 0x4040,
  kRateOfTurn = 0x8020,
  kTurnIncrement = 0x8030,  ///< "DeltaQ"
  kRateOfTurnHighRate = 0x8040,
  kStatusByte = 0xE010,
  kStatusWord = 0xE020,
};

/// Form of the numbers: bits 0 and 1 of the identifier.
enum class Precision : std::uint8_t { kFloat32 = 0, kFixed12Point20 = 1, kFixed16Point32 = 2, kFloat64 = 3 };

/// World frame of an attitude: bits 2 and 3 of the identifier.
enum class World : std::uint8_t { kEastNorthUp = 0, kNorthEastDown = 1, kNorthWestUp = 2 };

struct DataItem {
  std::uint16_t id = 0;  ///< as sent
  std::span<const std::uint8_t> data;

  [[nodiscard]] bool is(Item item) const noexcept {
    return (id & 0xFFF0U) == static_cast<std::uint16_t>(item);
  }
  [[nodiscard]] Precision precision() const noexcept { return static_cast<Precision>(id & 3U); }
  /// Nothing: the reserved fourth value.
  [[nodiscard]] std::optional<World> world() const noexcept;
  /// The length is that of `count` numbers of its precision.
  [[nodiscard]] bool has_numbers(std::size_t count) const noexcept;
  /// Number `index`, any precision; has_numbers() of more than `index`.
  [[nodiscard]] double number(std::size_t index) const noexcept;
  /// Unsigned integer of the first `bytes` bytes.
  [[nodiscard]] std::uint64_t integer(std::size_t bytes) const noexcept;
};

/// The items of a message's data fill it exactly, at least one.
[[nodiscard]] bool items_fill(std::span<const std::uint8_t> data) noexcept;

/// Takes the next item off data that items_fill(); nothing at its end.
[[nodiscard]] std::optional<DataItem> take_item(std::span<const std::uint8_t>& data) noexcept;

}  // namespace isobar::xsens
