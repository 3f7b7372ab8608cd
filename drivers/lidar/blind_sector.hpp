// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// Sector of the turn in which the sensor sends nothing, learned from the gaps: the sensor is set to a reduced
/// field of view. A gap that returns at the same place a turn later is such a sector; loss on the way does not
/// choose its place. Turns in 0.01 deg.
class BlindSector {
 public:
  /// Smallest sector that is told from loss.
  static constexpr std::uint32_t kLeast = 1'000;
  /// Largest change of its ends from turn to turn: some columns, or a packet.
  static constexpr std::uint32_t kTolerance = 500;

  /// Takes two successive columns, of one packet or of two.
  /// @param lost packets that the gap counts as lost
  /// @return packets counted as lost earlier that were none: nothing had been sent
  std::uint32_t add(std::uint32_t from, std::uint32_t to, std::uint32_t lost);

  /// Whether the sector is known: the same gap in two successive turns.
  [[nodiscard]] bool known() const { return known_; }
  /// Position of the last column before the sector.
  [[nodiscard]] std::uint32_t from() const { return from_; }
  [[nodiscard]] std::uint32_t width() const { return width_; }
  /// Whether the step between two successive columns crosses the sector.
  [[nodiscard]] bool crossed(std::uint32_t from, std::uint32_t to) const;
  /// Whether a position lies in the sector, its ends excluded.
  [[nodiscard]] bool holds(std::uint32_t turn) const;

 private:
  [[nodiscard]] bool is_same(std::uint32_t from, std::uint32_t width) const;

  bool known_ = false;
  bool seen_ = false;  // once, a candidate
  std::uint32_t from_ = 0;
  std::uint32_t width_ = 0;
  std::uint32_t lost_ = 0;   // counted for the candidate
  std::uint32_t swept_ = 0;  // since the candidate
};

}  // namespace isobar
