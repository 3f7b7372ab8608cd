// SPDX-License-Identifier: BSD-3-Clause
// What every barometer on this machine looks like to the thread that reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/samples.hpp"

namespace isobar {

enum class BarometerState : std::uint8_t {
  kStarting,     ///< not yet measured, nothing wrong so far
  kMeasuring,    ///< samples come
  kNoAnswer,     ///< device, bus or file cannot be reached
  kWrongDevice,  ///< something answers, but it is no such sensor, or its memory is not readable
  kSilent,       ///< it answers, but has no new result
  kStuck,        ///< the same bits again and again
  kImplausible,  ///< results that cannot be air pressure, or a voltage outside the span
};

/// Counted since the start; one writer.
struct BarometerCounters {
  std::uint64_t samples = 0;      ///< handed out
  std::uint64_t io_errors = 0;    ///< accesses that failed
  std::uint64_t starts = 0;       ///< initialisations begun, the first one too
  std::uint64_t resets = 0;       ///< the sensor had lost its settings: a brown-out
  std::uint64_t silent = 0;       ///< times that it fell silent
  std::uint64_t stuck = 0;        ///< times that its value froze
  std::uint64_t implausible = 0;  ///< results refused
  std::uint64_t torn = 0;         ///< reads during which a new result came, read again
};

/// What a barometer says of itself; plain, so that it travels between threads.
struct BarometerStatus {
  BarometerState state = BarometerState::kStarting;
  std::array<char, 96> fault{};     ///< why it does not measure, in words; empty while it does
  std::int64_t last_sample_ns = 0;  ///< robot clock, 0: none yet
  BarometerCounters counters;
};

/// A barometer that is asked when it wants to be. Nothing here throws, waits or sleeps: a device that is
/// missing is asked for again later.
class BarometerDevice {
 public:
  struct Step {
    bool has_sample = false;
    PressureSample sample;
    std::int64_t next_ns = 0;  ///< when step() is to be called again, robot clock
  };

  BarometerDevice() = default;
  virtual ~BarometerDevice() = default;
  BarometerDevice(const BarometerDevice&) = delete;
  BarometerDevice& operator=(const BarometerDevice&) = delete;

  /// Does what is due at `now_ns`, robot clock. One thread.
  virtual Step step(std::int64_t now_ns) noexcept = 0;
  [[nodiscard]] virtual const BarometerStatus& status() const noexcept = 0;
  /// What and where: "DPS310 on /dev/i2c-1 at 0x77". Does not change.
  [[nodiscard]] virtual const std::string& place() const noexcept = 0;
};

/// Without a good result for longer a device counts as silent [ns]. Three measurements, but at least 0.3 s:
/// from 8 Hz on it is flagged within 0.5 s.
[[nodiscard]] constexpr std::int64_t barometer_silence_ns(int rate_hz) noexcept {
  const std::int64_t three_ns = 3'000'000'000 / rate_hz;
  return three_ns > 300'000'000 ? three_ns : 300'000'000;
}

}  // namespace isobar
