// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "drivers/bus/register_bus.hpp"
#include "drivers/device/fault_watch.hpp"

namespace isobar {

/// What all barometers on a bus share: a polled state machine without blocking waits, which restarts after
/// every fault.
///
///   open the bus ──▶ start() ──▶ set_up() … ──▶ read() …
///     ▲ after a back-off: no answer, wrong device, lost settings, silent, stuck
///
/// A sensor supplies the three pieces. They are called at the times that they ask for, or later.
class PolledBarometer : public Device<PressureSample> {
 public:
  Step step(std::int64_t now_ns) noexcept final;
  [[nodiscard]] const DeviceStatus& status() const noexcept final { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept final { return place_; }

 protected:
  /// What a piece came to, made by the functions below.
  struct Outcome {
    enum class Kind : std::uint8_t { kWait, kMeasuring, kResult, kProblem, kFault };
    Kind kind = Kind::kWait;
    std::int64_t wait_ns = 0;          ///< time until the next piece
    std::int64_t first_result_ns = 0;  ///< kMeasuring: time until the first result can be there
    DeviceState state = DeviceState::kStarting;
    const char* what = nullptr;  ///< static text
    int error = 0;               ///< errno or 0
    bool lost_settings = false;
  };
  /// The same again after this time.
  static Outcome wait(std::int64_t wait_ns) noexcept;
  /// set_up() is complete; the first read() after this time.
  static Outcome measuring(std::int64_t wait_ns, std::int64_t first_result_ns) noexcept;
  /// read() has a result.
  static Outcome result(std::int64_t wait_ns) noexcept;
  /// A failed access or a bad result while measuring: a fault when no good result follows in time.
  static Outcome problem(DeviceState state, const char* what, std::int64_t wait_ns, int error = 0) noexcept;
  /// A restart after the back-off.
  static Outcome fault(DeviceState state, const char* what, int error = 0) noexcept;
  static Outcome no_answer(int error) noexcept;
  static Outcome lost_settings() noexcept;

  /// A result of read().
  struct Reading {
    std::int64_t bits = 0;  ///< raw pressure, for StuckWatch
    PressureSample sample;
    const char* refused = nullptr;  ///< the rule that it breaks, static; nullptr: none
    DeviceState refused_state = DeviceState::kImplausible;
  };

  /// @param place see Device
  /// @param silence_ns see device_silence_ns
  /// @param stuck_time_ns see StuckWatch
  PolledBarometer(std::string place, std::unique_ptr<RegisterBus> bus, std::int64_t silence_ns,
                  std::int64_t stuck_time_ns);

  /// Identification and reset, on an open bus. kWait: set_up() follows.
  virtual Outcome start(std::int64_t now_ns) noexcept = 0;
  /// The next piece of the set-up.
  virtual Outcome set_up(std::int64_t now_ns) noexcept = 0;
  /// One poll.
  virtual Outcome read(std::int64_t now_ns, Reading& reading) noexcept = 0;

  [[nodiscard]] RegisterBus& bus() noexcept { return *bus_; }
  /// Writes a register and reads it back. EIO: it holds another value in the bits of `mask`.
  int write_and_verify(std::uint8_t address, std::uint8_t value, std::uint8_t mask = 0xFF) noexcept;
  /// Reads registers until two reads agree: a read that meets a new result may mix two, where the bus has no
  /// bursts, and a bit flipped on the bus is found. EAGAIN: never in 4 reads. `bytes` are undefined after an
  /// error.
  int read_settled(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept;

 private:
  enum class Phase : std::uint8_t { kBegin, kSettingUp, kMeasuring };

  std::int64_t begin(std::int64_t now_ns) noexcept;
  std::int64_t proceed(const Outcome& outcome, std::int64_t now_ns) noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  void take(const Reading& reading, std::int64_t now_ns, Step& step) noexcept;
  std::int64_t restart(const Outcome& outcome, std::int64_t now_ns) noexcept;

  std::string place_;
  std::unique_ptr<RegisterBus> bus_;
  FaultWatch faults_;
  StuckWatch stuck_;
  Phase phase_ = Phase::kBegin;
};

/// Poll interval of a sensor with a ready bit [ns]: a quarter of the measurement period, from 4 to 20 ms. A
/// result is then known to half a poll.
[[nodiscard]] std::int64_t poll_interval_ns(int rate_hz) noexcept;

}  // namespace isobar
