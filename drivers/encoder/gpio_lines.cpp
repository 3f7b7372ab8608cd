// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/encoder/gpio_lines.hpp"

#include <sys/epoll.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>

namespace isobar::encoder {

GpioLines::GpioLines(const Settings& settings) {
  const auto encoders = settings.encoders();
  for (std::size_t i = 0; i < kMaxEncoders; ++i) {
    if (!encoders[i].present()) continue;
    const auto line = [&](int offset) {
      return std::make_unique<GpioLine>(settings.chip, static_cast<unsigned>(offset), GpioLine::Edges::kBoth);
    };
    lines_[2 * i] = line(encoders[i].a);
    lines_[2 * i + 1] = line(encoders[i].b);
  }
}

GpioLines::~GpioLines() { close(); }

void GpioLines::close() noexcept {
  if (poll_ >= 0) ::close(poll_);
  poll_ = -1;
  for (const auto& line : lines_) {
    if (line) line->close();
  }
}

int GpioLines::open() noexcept {
  close();
  poll_ = epoll_create1(EPOLL_CLOEXEC);
  int error = poll_ < 0 ? errno : 0;
  for (const auto& line : lines_) {
    if (error != 0 || !line) continue;
    error = line->open();
    epoll_event event{};
    event.events = EPOLLIN;
    if (error == 0 && epoll_ctl(poll_, EPOLL_CTL_ADD, line->file_descriptor(), &event) < 0) error = errno;
  }
  if (error != 0) close();
  return error;
}

int GpioLines::level(std::uint8_t encoder, Line line, bool& high) noexcept {
  const auto& asked = lines_[std::size_t{2} * encoder + static_cast<std::size_t>(line)];
  return asked ? asked->level(high) : EBADF;
}

int GpioLines::read(EdgeSorter& edges) noexcept {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!lines_[i]) continue;
    if (const int error = read_line(i, edges); error != 0) return error;
  }
  return 0;
}

int GpioLines::read_line(std::size_t index, EdgeSorter& edges) noexcept {
  std::array<LineEdge, EdgeLine::kQueue> waiting{};
  std::size_t count = 0;
  if (const int error = lines_[index]->read(waiting, count); error != 0) return error;
  if (count == EdgeLine::kQueue) ++full_queues_;
  for (std::size_t i = 0; i < count; ++i) {
    Edge edge;
    edge.stamp_ns = waiting[i].stamp_ns;
    edge.encoder = static_cast<std::uint8_t>(index / 2);
    edge.line = index % 2 == 0 ? Line::kA : Line::kB;
    edge.rising = waiting[i].rising;
    if (!edges.add(edge)) return 0;  // full: the loss shows as any other
  }
  return 0;
}

std::int64_t GpioLines::now_ns() const noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

}  // namespace isobar::encoder
