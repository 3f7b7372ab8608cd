// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "drivers/gpio/edge_line.hpp"
#include "drivers/pps/pulse_watch.hpp"

namespace isobar::pps {

struct PulseStatus {
  int error = 0;  ///< errno of the line that cannot be requested or read; 0: it is open
  PulseFigures figures;
};

/// A line with a pulse a second. It needs no thread of its own: the kernel stamps the edges and keeps 16 of them. Nothing
/// throws or waits; after construction nothing is allocated but by libgpiod when the line is requested. One thread.
class PulseInput {
 public:
  explicit PulseInput(std::unique_ptr<EdgeLine> line) : line_(std::move(line)) {}

  /// Takes the edges that wait. Call it every 25 ms: the offset of the system clock is that at the call.
  void poll(const ClockPair& now) noexcept;
  [[nodiscard]] PulseStatus status() const noexcept { return {error_, watch_.figures()}; }

 private:
  void fail(int error, std::int64_t now_ns) noexcept;

  std::unique_ptr<EdgeLine> line_;
  PulseWatch watch_;
  bool open_ = false;
  int error_ = 0;
  std::int64_t next_try_ns_ = 0;  ///< CLOCK_MONOTONIC
};

}  // namespace isobar::pps
