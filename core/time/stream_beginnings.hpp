// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>

#include "core/time/clock_continuity.hpp"

namespace isobar {

/// Finds that a stream of samples begins anew: its numbers do, or its sender's clock jumps after a pause. A
/// clock that is set in a running stream is no new beginning. One thread.
class StreamBeginnings {
 public:
  /// Takes the number of a sample, where there is one.
  void add_number(std::uint32_t number, std::int64_t host_ns) noexcept {
    began_ = number_.add(number, host_ns) || began_;
  }
  /// Takes the stamp of a sample on its sender's clock, where there is one; see ClockContinuity::add().
  void add_stamp(std::int64_t sender_ns, std::int64_t host_ns) noexcept {
    began_ = (clock_.add(sender_ns, host_ns) && clock_.jumped_after_pause()) || began_;
  }
  /// True once for each new beginning; two at once are one.
  bool take() noexcept { return std::exchange(began_, false); }

 private:
  NumberContinuity number_;
  ClockContinuity clock_;
  bool began_ = false;
};

}  // namespace isobar
