// SPDX-License-Identifier: BSD-3-Clause
// Device<Sample>: the contract of every sensor that this machine reads itself, at a bus, a line or a file.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/samples.hpp"

namespace isobar {

enum class DeviceState : std::uint8_t {
  kStarting,     ///< initialising, no fault so far
  kMeasuring,    ///< delivers samples
  kNoAnswer,     ///< device, bus or file cannot be reached
  kWrongDevice,  ///< another device answers, or the sensor's memory is unreadable
  kSilent,       ///< answers without a new result
  kStuck,        ///< the result's bits no longer change
  kImplausible,  ///< a value outside the plausible range, or a voltage outside the span
};

/// Counters since construction; one writer.
struct DeviceCounters {
  std::uint64_t samples = 0;      ///< delivered
  std::uint64_t io_errors = 0;    ///< failed accesses
  std::uint64_t starts = 0;       ///< initialisations, including the first
  std::uint64_t resets = 0;       ///< losses of the sensor's settings (brown-out)
  std::uint64_t silent = 0;       ///< faults of state kSilent
  std::uint64_t stuck = 0;        ///< faults of state kStuck
  std::uint64_t implausible = 0;  ///< refused results
  std::uint64_t torn = 0;         ///< reads repeated because the result changed meanwhile
  std::uint64_t corrupt = 0;      ///< messages of a stream with a wrong checksum or a wrong length
};

/// Status of a device; trivially copyable, to be passed between threads.
struct DeviceStatus {
  DeviceState state = DeviceState::kStarting;
  std::array<char, 96> fault{};     ///< fault text; empty while measuring
  std::array<char, 96> note{};      ///< what limits the device while it works, in words; empty: nothing
  std::int64_t last_sample_ns = 0;  ///< robot clock; 0: none yet
  DeviceCounters counters;
};

/// A sensor that one thread drives by step(): opening, set-up, reading, and the next try after a fault with a
/// growing pause (FaultWatch). Nothing throws, waits, sleeps or, after construction, allocates: an absent
/// device is retried at a later step.
///
///     do {
///       step = device.step(now);
///       if (step.has_sample) publish(step.sample);
///     } while (wait until step.next_ns, or until device.file_descriptor() is readable);
template <class Sample>
class Device {
 public:
  struct Step {
    bool has_sample = false;
    Sample sample;
    std::int64_t next_ns =
        0;  ///< latest time of the next step(), robot clock; not after now: more is waiting
  };

  Device() = default;
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Performs the work due at `now_ns`, robot clock. Call from one thread.
  virtual Step step(std::int64_t now_ns) noexcept = 0;
  /// Descriptor whose readability is a reason for an earlier step(); -1: none, at present or ever, the device
  /// is polled. It may change at every step().
  [[nodiscard]] virtual int file_descriptor() const noexcept { return -1; }
  [[nodiscard]] virtual const DeviceStatus& status() const noexcept = 0;
  /// Sensor and address, constant: "DPS310 on /dev/i2c-1 at 0x77".
  [[nodiscard]] virtual const std::string& place() const noexcept = 0;
};

/// A reading of an inertial sensor, which may carry a barometer of its own.
struct InertialReading {
  ImuSample imu;
  PressureSample pressure;
  bool has_imu = false;
  bool has_pressure = false;
};

/// Time without a good result after which a device is silent [ns]: three measurements, at least 0.3 s. From 8
/// Hz on, silence is reported within 0.5 s.
[[nodiscard]] constexpr std::int64_t device_silence_ns(int rate_hz) noexcept {
  const std::int64_t three_ns = 3'000'000'000 / rate_hz;
  return three_ns > 300'000'000 ? three_ns : 300'000'000;
}

}  // namespace isobar
