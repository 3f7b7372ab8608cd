// SPDX-License-Identifier: BSD-3-Clause
// Counts of a quadrature encoder from the edges of its two lines, without I/O.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace isobar::encoder {

/// Line of an encoder. Forward, A leads B.
enum class Line : std::uint8_t { kA, kB };

/// An edge, as the kernel reports it.
struct Edge {
  std::int64_t stamp_ns = 0;  ///< CLOCK_MONOTONIC
  std::uint8_t encoder = 0;   ///< index of the encoder
  Line line = Line::kA;
  bool rising = false;
};

/// Counters since construction.
struct QuadratureCounters {
  std::uint64_t edges = 0;
  /// Edges that the kernel's queue dropped, at least: two edges of one line in the same direction have one of
  /// the other direction between them.
  std::uint64_t lost = 0;
  /// Lost edges whose direction is known, which were counted nevertheless.
  std::uint64_t restored = 0;
};

/// Four counts a period, in both directions (gray code):
///
///   forward:  A rises (B low), B rises (A high), A falls (B high), B falls (A low)
///
/// Edges come in the order of their stamps. After a lost edge the level of its line is believed wrongly until
/// the line's next edge, and edges of the other line are counted in the wrong direction meanwhile. That next
/// edge shows it: where the other line had two edges in between, the encoder went on in one direction, and
/// the count is corrected; where it had none, the two edges cancel; else the direction is not known, and
/// nothing is corrected. A run of lost edges that is even on both lines leaves no trace here: see
/// EdgeSource::full_queues().
class QuadratureDecoder {
 public:
  /// Forgets the edges, keeps count and counters.
  /// @param a,b levels of the lines
  void start(bool a, bool b) noexcept;
  void add(const Edge& edge) noexcept;

  /// Counts since construction, forward positive.
  [[nodiscard]] std::int64_t count() const noexcept { return count_; }
  [[nodiscard]] const QuadratureCounters& counters() const noexcept { return counters_; }

 private:
  void restore(std::size_t line, int direction) noexcept;

  std::array<bool, 2> level_{};
  std::array<int, 2> others_{};  ///< edges of the other line since this line's last edge
  std::int64_t count_ = 0;
  QuadratureCounters counters_;
};

/// Puts edges of several lines into the order of their stamps: libgpiod 1.6 delivers each line by itself.
/// It allocates nothing: it holds the full queues of 16 lines.
class EdgeSorter {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// False, and nothing is added, when it is full.
  bool add(const Edge& edge) noexcept;
  /// Passes edges up to this time to `use`, oldest first, and removes them. Edges that are read after the
  /// others can be older than those only if they are newer than the begin of the reading: that is the time to
  /// give.
  template <class Use>
  void release(std::int64_t until_ns, const Use& use) noexcept {
    std::size_t used = 0;
    while (used < size_ && edges_[used].stamp_ns <= until_ns) use(edges_[used++]);
    remove_first(used);
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  void clear() noexcept { size_ = 0; }

 private:
  void remove_first(std::size_t count) noexcept;

  std::array<Edge, kCapacity> edges_{};
  std::size_t size_ = 0;
};

}  // namespace isobar::encoder
