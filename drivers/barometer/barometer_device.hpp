// SPDX-License-Identifier: BSD-3-Clause
// Interface of the barometers attached to this machine, polled by one thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/samples.hpp"

namespace isobar {

enum class BarometerState : std::uint8_t {
  kStarting,     ///< initialising, no fault so far
  kMeasuring,    ///< delivers samples
  kNoAnswer,     ///< device, bus or file cannot be reached
  kWrongDevice,  ///< another device answers, or the sensor's memory is unreadable
  kSilent,       ///< answers without a new result
  kStuck,        ///< the result's bits no longer change
  kImplausible,  ///< a pressure outside the plausible range, or a voltage outside the span
};

/// Counters since construction; one writer.
struct BarometerCounters {
  std::uint64_t samples = 0;      ///< delivered
  std::uint64_t io_errors = 0;    ///< failed accesses
  std::uint64_t starts = 0;       ///< initialisations, including the first
  std::uint64_t resets = 0;       ///< losses of the sensor's settings (brown-out)
  std::uint64_t silent = 0;       ///< faults of state kSilent
  std::uint64_t stuck = 0;        ///< faults of state kStuck
  std::uint64_t implausible = 0;  ///< refused results
  std::uint64_t torn = 0;         ///< reads repeated because the result changed meanwhile
};

/// Status of a barometer; trivially copyable, to be passed between threads.
struct BarometerStatus {
  BarometerState state = BarometerState::kStarting;
  std::array<char, 96> fault{};     ///< fault text; empty while measuring
  std::int64_t last_sample_ns = 0;  ///< robot clock; 0: none yet
  BarometerCounters counters;
};

/// A polled barometer, which chooses the time of the next poll. Nothing throws, waits or sleeps: an absent
/// device is retried at a later poll.
class BarometerDevice {
 public:
  struct Step {
    bool has_sample = false;
    PressureSample sample;
    std::int64_t next_ns = 0;  ///< time of the next step(), robot clock
  };

  BarometerDevice() = default;
  virtual ~BarometerDevice() = default;
  BarometerDevice(const BarometerDevice&) = delete;
  BarometerDevice& operator=(const BarometerDevice&) = delete;

  /// Performs the work due at `now_ns`, robot clock. Call from one thread.
  virtual Step step(std::int64_t now_ns) noexcept = 0;
  [[nodiscard]] virtual const BarometerStatus& status() const noexcept = 0;
  /// Sensor and address, constant: "DPS310 on /dev/i2c-1 at 0x77".
  [[nodiscard]] virtual const std::string& place() const noexcept = 0;
};

/// Time without a good result after which a device is silent [ns]: three measurements, at least 0.3 s. From 8
/// Hz on, silence is reported within 0.5 s.
[[nodiscard]] constexpr std::int64_t barometer_silence_ns(int rate_hz) noexcept {
  const std::int64_t three_ns = 3'000'000'000 / rate_hz;
  return three_ns > 300'000'000 ? three_ns : 300'000'000;
}

}  // namespace isobar
