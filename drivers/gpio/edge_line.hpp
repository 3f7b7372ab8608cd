// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

struct gpiod_line;

namespace isobar {

/// An edge, as the kernel reports it.
struct LineEdge {
  std::int64_t stamp_ns = 0;  ///< CLOCK_MONOTONIC
  bool rising = false;
};

/// A digital line that reports edges. Every call returns 0 or an errno value; nothing throws.
class EdgeLine {
 public:
  /// The kernel's queue of a line: edges that come while 16 wait are dropped without a sign.
  static constexpr std::size_t kQueue = 16;

  EdgeLine() = default;
  virtual ~EdgeLine() = default;
  EdgeLine(const EdgeLine&) = delete;
  EdgeLine& operator=(const EdgeLine&) = delete;

  /// Requests the line, or requests it again.
  virtual int open() noexcept = 0;
  virtual void close() noexcept = 0;
  virtual int level(bool& high) noexcept = 0;
  /// Takes up to kQueue edges that wait, oldest first.
  virtual int read(std::span<LineEdge, kQueue> edges, std::size_t& count) noexcept = 0;
  /// Time of the clock of the edges' stamps [ns].
  [[nodiscard]] virtual std::int64_t now_ns() const noexcept = 0;
  /// Readable when edges wait; -1: not open.
  [[nodiscard]] virtual int file_descriptor() const noexcept = 0;
};

/// A line of a GPIO chip, through libgpiod 1.6.
class GpioLine final : public EdgeLine {
 public:
  enum class Edges : std::uint8_t { kRising, kBoth };

  /// Does not request the line; open() does.
  /// @param chip "/dev/gpiochip0"
  GpioLine(std::string chip, unsigned offset, Edges edges);
  ~GpioLine() override;

  /// EBUSY: another program, or a kernel driver, holds the line. EINVAL: the chip has no such line.
  int open() noexcept override;
  void close() noexcept override;
  int level(bool& high) noexcept override;
  int read(std::span<LineEdge, kQueue> edges, std::size_t& count) noexcept override;
  [[nodiscard]] std::int64_t now_ns() const noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override { return file_; }

 private:
  std::string chip_;
  unsigned offset_;
  Edges edges_;
  gpiod_line* line_ = nullptr;
  int file_ = -1;  ///< the line's, owned by it
};

}  // namespace isobar
