// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/time/clock_anchor.hpp"
#include "drivers/device/fault_watch.hpp"
#include "drivers/device/inertial_watch.hpp"
#include "drivers/serial/imu_protocol.hpp"
#include "drivers/serial/port.hpp"

namespace isobar::serial {

/// Inertial sensor on a serial line: a state machine without blocking waits, which starts again after every
/// fault:
///
///   open ──▶ dialogue: command, answer, next command … ──▶ measurements
///     ▲ after a back-off of at most 0.5 s: no port, hang-up, no answer, refusal, silence, stuck, implausible
///
/// A message's stamp is the receive time of its bytes less their time on the line; the sensor's own clock,
/// where the messages carry it, takes the jitter out (ClockAnchor). The delay of the sensor's filters is not
/// known here and stays in.
class SerialImu final : public Device<InertialReading> {
 public:
  /// @param name "VN-100"; @param rate_hz expected measurements per second
  SerialImu(const std::string& name, const std::string& port, int baud, int rate_hz,
            std::unique_ptr<ImuProtocol> protocol);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return port_.file_descriptor(); }
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

 private:
  enum class Phase : std::uint8_t { kClosed, kDialogue, kMeasuring };

  std::int64_t open(std::int64_t now_ns) noexcept;
  std::int64_t converse(std::int64_t now_ns) noexcept;
  std::int64_t send(std::int64_t now_ns) noexcept;
  std::int64_t no_answer(std::int64_t now_ns) noexcept;
  std::int64_t begin_measuring(std::int64_t now_ns) noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  /// Reads what waits in the kernel. 0 or errno.
  int receive(std::int64_t now_ns) noexcept;
  /// The next event, from the bytes at hand or the kernel's; kNone: nothing more at present.
  ImuEvent next_event(std::int64_t now_ns, int& error) noexcept;
  bool take_reading(const ImuEvent& event, std::int64_t now_ns, Step& step) noexcept;
  void take_pressure(InertialReading& reading) noexcept;
  std::int64_t stamp_of(const ImuEvent& event) noexcept;
  std::int64_t fail(DeviceState state, const char* what, std::int64_t now_ns, int error = 0) noexcept;

  std::string place_;
  Port port_;
  std::unique_ptr<ImuProtocol> protocol_;
  std::int64_t silence_ns_;
  FaultWatch faults_;
  InertialWatch watch_;
  ClockAnchor anchor_;
  Phase phase_ = Phase::kClosed;
  int tries_ = 0;
  std::int64_t deadline_ns_ = 0;     ///< of the answer
  std::int64_t received_ns_ = 0;     ///< time of the newest read that found bytes
  std::int64_t newest_good_ns_ = 0;  ///< newest measurement, or begin of measuring
  bool heard_bytes_ = false;         ///< since the port was opened
  bool heard_messages_ = false;      ///< since the port was opened
  double pressure_pa_ = 0.0;         ///< newest one delivered
  std::int64_t pressure_ns_ = 0;     ///< its time
};

}  // namespace isobar::serial
