// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "drivers/encoder/edge_source.hpp"
#include "drivers/encoder/settings.hpp"

struct gpiod_chip;
struct gpiod_line;

namespace isobar::encoder {

/// Lines of a GPIO chip through libgpiod 1.6. The kernel stamps edges with CLOCK_MONOTONIC and holds 16 a line;
/// those that come while 16 wait are dropped without a sign.
class GpioLines final : public EdgeSource {
 public:
  /// Does not request the lines; open() does.
  explicit GpioLines(const Settings& settings);
  ~GpioLines() override;

  /// EBUSY: another program, or a kernel driver, holds a line. EINVAL: the chip has no such line.
  int open() noexcept override;
  void close() noexcept override;
  int level(std::uint8_t encoder, Line line, bool& high) noexcept override;
  int read(EdgeSorter& edges) noexcept override;
  [[nodiscard]] std::uint64_t full_queues() const noexcept override { return full_queues_; }
  [[nodiscard]] std::int64_t now_ns() const noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return poll_; }

 private:
  static constexpr std::size_t kLines = 2 * kMaxEncoders;

  int request(std::size_t index, unsigned offset) noexcept;
  int read_line(std::size_t index, EdgeSorter& edges) noexcept;

  std::string path_;
  std::array<int, kLines> offsets_{};  ///< A and B of each encoder; -1: none
  gpiod_chip* chip_ = nullptr;
  std::array<gpiod_line*, kLines> lines_{};
  std::uint64_t full_queues_ = 0;
  int poll_ = -1;  ///< epoll instance of all lines
};

}  // namespace isobar::encoder
