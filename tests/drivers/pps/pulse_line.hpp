// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "drivers/gpio/edge_line.hpp"

namespace isobar::test {

/// A line with the kernel's queue of edges, which the test fills.
class PulseLine final : public EdgeLine {
 public:
  int open() noexcept override {
    ++opens;
    return open_error;
  }
  void close() noexcept override { ++closes; }
  int level(bool& high) noexcept override {
    high = false;
    return 0;
  }
  int read(std::span<LineEdge, kQueue> edges, std::size_t& count) noexcept override {
    for (count = 0; count < kQueue && !waiting.empty(); ++count) {
      edges[count] = waiting.front();
      waiting.pop_front();
    }
    return read_error;
  }
  [[nodiscard]] std::int64_t now_ns() const noexcept override { return 0; }
  [[nodiscard]] int file_descriptor() const noexcept override { return -1; }

  std::deque<LineEdge> waiting;
  int open_error = 0;
  int read_error = 0;
  int opens = 0;
  int closes = 0;
};

}  // namespace isobar::test
