// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/encoder/gpio_lines.hpp"

#include <fcntl.h>
#include <gpiod.h>
#include <sys/epoll.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>

namespace isobar::encoder {

namespace {

/// The kernel's queue of a line.
constexpr std::size_t kQueue = 16;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

std::int64_t to_ns(const timespec& time) { return time.tv_sec * kNsPerSecond + time.tv_nsec; }

}  // namespace

GpioLines::GpioLines(const Settings& settings) : path_(settings.chip) {
  const auto encoders = settings.encoders();
  for (std::size_t i = 0; i < kMaxEncoders; ++i) {
    offsets_[2 * i] = encoders[i].present() ? encoders[i].a : -1;
    offsets_[2 * i + 1] = encoders[i].present() ? encoders[i].b : -1;
  }
}

GpioLines::~GpioLines() { close(); }

void GpioLines::close() noexcept {
  if (poll_ >= 0) ::close(poll_);
  poll_ = -1;
  if (chip_ != nullptr) gpiod_chip_close(chip_);  // releases the lines
  chip_ = nullptr;
  lines_ = {};
}

int GpioLines::open() noexcept {
  close();
  chip_ = gpiod_chip_open(path_.c_str());
  if (chip_ == nullptr) return errno;
  poll_ = epoll_create1(EPOLL_CLOEXEC);
  int error = poll_ < 0 ? errno : 0;
  for (std::size_t i = 0; error == 0 && i < kLines; ++i) {
    if (offsets_[i] >= 0) error = request(i, static_cast<unsigned>(offsets_[i]));
  }
  if (error != 0) close();
  return error;
}

int GpioLines::request(std::size_t index, unsigned offset) noexcept {
  gpiod_line* line = gpiod_chip_get_line(chip_, offset);
  if (line == nullptr) return errno;
  if (gpiod_line_request_both_edges_events(line, "isobard") < 0) return errno;
  const int file = gpiod_line_event_get_fd(line);
  if (file < 0) return errno;
  const int flags = fcntl(file, F_GETFL);
  if (flags < 0 || fcntl(file, F_SETFL, flags | O_NONBLOCK) < 0) return errno;
  epoll_event event{};
  event.events = EPOLLIN;
  if (epoll_ctl(poll_, EPOLL_CTL_ADD, file, &event) < 0) return errno;
  lines_[index] = line;
  return 0;
}

int GpioLines::level(std::uint8_t encoder, Line line, bool& high) noexcept {
  gpiod_line* const asked = lines_[2 * encoder + static_cast<std::size_t>(line)];
  if (asked == nullptr) return EBADF;
  const int value = gpiod_line_get_value(asked);
  if (value < 0) return errno;
  high = value != 0;
  return 0;
}

int GpioLines::read(EdgeSorter& edges) noexcept {
  for (std::size_t i = 0; i < kLines; ++i) {
    if (lines_[i] == nullptr) continue;
    if (const int error = read_line(i, edges); error != 0) return error;
  }
  return 0;
}

int GpioLines::read_line(std::size_t index, EdgeSorter& edges) noexcept {
  std::array<gpiod_line_event, kQueue> events{};
  const int count = gpiod_line_event_read_multiple(lines_[index], events.data(), events.size());
  if (count < 0) return errno == EAGAIN ? 0 : errno;
  const auto read = static_cast<std::size_t>(count);
  if (read == kQueue) ++full_queues_;
  for (std::size_t i = 0; i < read; ++i) {
    Edge edge;
    edge.stamp_ns = to_ns(events[i].ts);
    edge.encoder = static_cast<std::uint8_t>(index / 2);
    edge.line = index % 2 == 0 ? Line::kA : Line::kB;
    edge.rising = events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE;
    if (!edges.add(edge)) return 0;  // full: the loss shows as any other
  }
  return 0;
}

std::int64_t GpioLines::now_ns() const noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return to_ns(now);
}

}  // namespace isobar::encoder
