// SPDX-License-Identifier: BSD-3-Clause
// What differs between the inertial sensors on serial lines: the form of their messages, and the dialogue that
// sets them up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/device/device.hpp"

namespace isobar::serial {

/// One step through the received bytes.
struct ImuEvent {
  enum class Kind : std::uint8_t {
    kNone,     ///< no whole message is left
    kOther,    ///< a message of no use here
    kAnswer,   ///< the sensor accepts the command of the dialogue
    kRefusal,  ///< the sensor refuses the command; see ImuProtocol::refusal()
    kReading,  ///< a measurement
  };
  Kind kind = Kind::kNone;
  InertialReading reading;       ///< without stamps
  bool has_device_time = false;  ///< device_ns is valid
  std::int64_t device_ns = 0;    ///< the sensor's own clock at the measurement; wraps after clock_period_ns()
  std::size_t bytes_on_line = 0;    ///< bytes received since the message's first one, that one included
  const char* complaint = nullptr;  ///< static text of an error that the sensor reports, nullptr: none
};

/// Bytes of one kind of sensor to messages, and its dialogue. Nothing waits, throws or allocates.
class ImuProtocol {
 public:
  ImuProtocol() = default;
  virtual ~ImuProtocol() = default;
  ImuProtocol(const ImuProtocol&) = delete;
  ImuProtocol& operator=(const ImuProtocol&) = delete;

  /// The port was opened: forgets all bytes; the dialogue begins anew.
  virtual void restart() noexcept = 0;
  /// Free bytes to read into.
  virtual std::span<std::uint8_t> room() noexcept = 0;
  virtual void filled(std::size_t count) noexcept = 0;
  /// No byte came for longer than a pause within a message: what is incomplete stays so.
  virtual void give_up_incomplete() noexcept = 0;
  virtual ImuEvent next() noexcept = 0;

  /// Command of the dialogue that waits for its answer; empty: the sensor is set up.
  [[nodiscard]] virtual std::span<const std::uint8_t> command() const noexcept = 0;
  /// That command in words, "$VNWRG,75".
  [[nodiscard]] virtual const char* command_name() const noexcept = 0;
  /// The last refusal in words.
  [[nodiscard]] virtual const char* refusal() const noexcept = 0;
  /// What the silent line holds instead of measurements, nullptr: nothing known.
  [[nodiscard]] virtual const char* heard_instead() const noexcept { return nullptr; }
  /// Messages with a wrong checksum since construction.
  [[nodiscard]] virtual std::uint64_t corrupt() const noexcept = 0;
  /// Period of the sensor's clock [ns]; 0: it does not wrap.
  [[nodiscard]] virtual std::int64_t clock_period_ns() const noexcept { return 0; }
};

}  // namespace isobar::serial
