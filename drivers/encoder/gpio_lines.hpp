// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "drivers/encoder/edge_source.hpp"
#include "drivers/encoder/settings.hpp"
#include "drivers/gpio/edge_line.hpp"

namespace isobar::encoder {

/// Lines of a GPIO chip.
class GpioLines final : public EdgeSource {
 public:
  /// Does not request the lines; open() does.
  explicit GpioLines(const Settings& settings);
  ~GpioLines() override;

  /// See GpioLine::open().
  int open() noexcept override;
  void close() noexcept override;
  int level(std::uint8_t encoder, Line line, bool& high) noexcept override;
  int read(EdgeSorter& edges) noexcept override;
  [[nodiscard]] std::uint64_t full_queues() const noexcept override { return full_queues_; }
  [[nodiscard]] std::int64_t now_ns() const noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return poll_; }

 private:
  int read_line(std::size_t index, EdgeSorter& edges) noexcept;

  std::array<std::unique_ptr<GpioLine>, 2 * kMaxEncoders> lines_;  ///< A and B of each encoder; null: none
  std::uint64_t full_queues_ = 0;
  int poll_ = -1;  ///< epoll instance of all lines
};

}  // namespace isobar::encoder
