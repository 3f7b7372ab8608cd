// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/gpio/edge_line.hpp"

#include <fcntl.h>
#include <gpiod.h>
#include <time.h>

#include <array>
#include <cerrno>

namespace isobar {

namespace {

constexpr const char* kConsumer = "isobard";

std::int64_t to_ns(const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; }

}  // namespace

GpioLine::GpioLine(std::string chip, unsigned offset, Edges edges)
    : chip_(std::move(chip)), offset_(offset), edges_(edges) {}

GpioLine::~GpioLine() { close(); }

void GpioLine::close() noexcept {
  if (line_ != nullptr) gpiod_line_close_chip(line_);  // releases the line
  line_ = nullptr;
  file_ = -1;
}

int GpioLine::open() noexcept {
  close();
  gpiod_chip* const chip = gpiod_chip_open(chip_.c_str());
  if (chip == nullptr) return errno;
  line_ = gpiod_chip_get_line(chip, offset_);
  if (line_ == nullptr) {
    const int error = errno;
    gpiod_chip_close(chip);
    return error;
  }
  const int requested = edges_ == Edges::kBoth ? gpiod_line_request_both_edges_events(line_, kConsumer)
                                               : gpiod_line_request_rising_edge_events(line_, kConsumer);
  if (requested == 0) file_ = gpiod_line_event_get_fd(line_);
  const int flags = file_ < 0 ? -1 : fcntl(file_, F_GETFL);
  if (flags < 0 || fcntl(file_, F_SETFL, flags | O_NONBLOCK) < 0) {
    const int error = errno;
    close();
    return error;
  }
  return 0;
}

int GpioLine::level(bool& high) noexcept {
  if (line_ == nullptr) return EBADF;
  const int value = gpiod_line_get_value(line_);
  if (value < 0) return errno;
  high = value != 0;
  return 0;
}

int GpioLine::read(std::span<LineEdge, kQueue> edges, std::size_t& count) noexcept {
  count = 0;
  if (line_ == nullptr) return EBADF;
  std::array<gpiod_line_event, kQueue> events{};
  const int waiting = gpiod_line_event_read_multiple(line_, events.data(), events.size());
  if (waiting < 0) return errno == EAGAIN ? 0 : errno;
  for (; count < static_cast<std::size_t>(waiting); ++count) {
    edges[count] = {to_ns(events[count].ts), events[count].event_type == GPIOD_LINE_EVENT_RISING_EDGE};
  }
  return 0;
}

std::int64_t GpioLine::now_ns() const noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return to_ns(now);
}

}  // namespace isobar
