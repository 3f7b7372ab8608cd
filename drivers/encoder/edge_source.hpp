// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/encoder/quadrature.hpp"

namespace isobar::encoder {

/// Lines of encoders that report edges. Every call returns 0 or an errno value; nothing throws.
class EdgeSource {
 public:
  EdgeSource() = default;
  virtual ~EdgeSource() = default;
  EdgeSource(const EdgeSource&) = delete;
  EdgeSource& operator=(const EdgeSource&) = delete;

  /// Requests the lines, or requests them again.
  virtual int open() noexcept = 0;
  virtual void close() noexcept = 0;
  /// Level of a line. Valid after open().
  virtual int level(std::uint8_t encoder, Line line, bool& high) noexcept = 0;
  /// Adds the edges that wait.
  virtual int read(EdgeSorter& edges) noexcept = 0;
  /// Reads of a line's queue that found it full: edges after those in it were dropped. Since construction.
  [[nodiscard]] virtual std::uint64_t full_queues() const noexcept = 0;
  /// Time of the clock of the edges' stamps [ns].
  [[nodiscard]] virtual std::int64_t now_ns() const noexcept = 0;
  /// Readable when edges wait; -1: not open.
  [[nodiscard]] virtual int file_descriptor() const noexcept = 0;
};

}  // namespace isobar::encoder
