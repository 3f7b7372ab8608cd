// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/pps/pulse_input.hpp"
#include "drivers/pps/settings.hpp"
#include "ipc/topics.hpp"

namespace isobar {

/// The pulse a second at a GPIO line, and its health entries. Main thread.
class PulseSupervisor {
 public:
  /// Of a line that is not configured nothing is read and nothing said.
  explicit PulseSupervisor(const pps::Settings& settings);
  /// @param line stands in for the chip's, for tests
  PulseSupervisor(const pps::Settings& settings, std::unique_ptr<EdgeLine> line);

  /// Every tick of the supervise loop.
  void poll(const ClockPair& now) noexcept;
  /// Entries `pps`, `pps/missing`, `pps/extra`. Growth of counters refers to the last call.
  void fill(ipc::HealthReport& report);

 private:
  pps::Settings settings_;
  std::unique_ptr<pps::PulseInput> input_;  // null: none
  std::int64_t polled_ns_ = 0;              // CLOCK_MONOTONIC
  std::int64_t since_ns_ = 0;               // of the first poll
  pps::PulseFigures last_;
};

}  // namespace isobar
