// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar::ouster {

/// Evidence that the sensor divides its turn otherwise than the metadata says, from another lidar_mode: ids beyond
/// the turn's columns, or a turn that begins again long before its last column. Half as many columns would
/// otherwise put a turn into half of it.
class TurnEvidence {
 public:
  explicit TurnEvidence(int columns) : columns_(static_cast<std::uint32_t>(columns)) {}

  struct Span {
    std::uint32_t first_id;
    std::uint32_t last_id;
    std::int64_t first_ns;
    std::int64_t last_ns;
  };
  /// Takes the columns of a packet, in the order of arrival.
  void add(const Span& packet);
  /// Whether the packets of the last turn contradict.
  [[nodiscard]] bool contradicts() const { return doubt_ > 0; }
  /// Columns of a turn as the packets have them, at least.
  [[nodiscard]] std::uint32_t seen_columns() const { return seen_columns_; }

 private:
  /// Packets that a finding holds for: a turn of 4096 columns.
  static constexpr int kPacketsOfDoubt = 256;

  [[nodiscard]] bool begins_early(const Span& packet) const;

  std::uint32_t columns_;
  bool have_last_ = false;
  Span last_{};
  int doubt_ = 0;
  std::uint32_t seen_columns_ = 0;
};

}  // namespace isobar::ouster
