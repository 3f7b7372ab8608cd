// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/pps/pulse_input.hpp"

#include <array>

namespace isobar::pps {

namespace {

constexpr std::int64_t kRetryNs = 1'000'000'000;

}  // namespace

void PulseInput::poll(const ClockPair& now) noexcept {
  if (!open_) {
    if (now.monotonic_ns < next_try_ns_) return;
    if (const int error = line_->open(); error != 0) {
      fail(error, now.monotonic_ns);
      return;
    }
    open_ = true;
    error_ = 0;
  }
  std::array<LineEdge, EdgeLine::kQueue> edges{};
  std::size_t count = 0;
  if (const int error = line_->read(edges, count); error != 0) {
    fail(error, now.monotonic_ns);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (edges[i].rising) watch_.add(edges[i].stamp_ns, now);
  }
}

void PulseInput::fail(int error, std::int64_t now_ns) noexcept {
  line_->close();
  watch_.interrupt();
  open_ = false;
  error_ = error;
  next_try_ns_ = now_ns + kRetryNs;
}

}  // namespace isobar::pps
