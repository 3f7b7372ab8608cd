// SPDX-License-Identifier: BSD-3-Clause
// Coarse levels of a slab's image, each an upper bound of the finer ones, for branch and bound.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/place/slab_image.hpp"

namespace isobar {

/// Levels 0 (the image itself) … kTop. An entry of level h stands for a block of 2^h x 2^h cells, and is the maximum over
/// all cells that a point may reach whose block is this one, for 2^h positions along each axis and 2^h headings of the
/// robot. With s = 2^h and d = s / 2, these are s i - d … s (i + 2) - 2 + d along each axis. Source: M. Hess, D. Kohler,
/// H. Rapp, D. Andor, "Real-Time Loop Closure in 2D LIDAR SLAM", ICRA 2016, section V-B (max-pooled grids as bounds); here
/// headings are halved with the positions, and a level keeps one entry a block, so that it stays in the cache.
class SlabPyramid {
 public:
  static constexpr int kTop = 3;
  static constexpr int kLanes = 16;  ///< neighbouring entries that one step of the search adds up

  struct Level {
    int width = 0;                         ///< blocks
    int height = 0;                        ///< blocks
    std::size_t pitch = 0;                 ///< entries from row to row
    const std::uint8_t* scores = nullptr;  ///< 0 … SlabImage::kFullScore
  };

  /// Rebuilds all levels. `image` must outlive the next find(). O(walls), besides clearing memory.
  void build(const SlabImage& image);
  [[nodiscard]] const Level& level(int h) const { return levels_[static_cast<std::size_t>(h)]; }
  /// True if the robot may stand in a cell of the block.
  [[nodiscard]] bool standing(int h, int column, int row) const {
    const int block = h >= kStandingLevel ? column : column >> (kStandingLevel - h);
    const int block_row = h >= kStandingLevel ? row : row >> (kStandingLevel - h);
    const int at = h > kStandingLevel ? 1 : 0;
    return standing_[static_cast<std::size_t>(at)]
                    [static_cast<std::size_t>(block_row) * standing_pitch_[static_cast<std::size_t>(at)] +
                     static_cast<std::size_t>(block)] != 0;
  }

 private:
  static constexpr int kStandingLevel = 2;
  static_assert(1 << kStandingLevel == SlabImage::kStandingCells && kTop == kStandingLevel + 1);

  void pool_scores(const SlabImage& image, int h);
  void raise(std::vector<std::uint8_t>& scores, int h, int column, int row, int beside,
             std::uint8_t score) const;
  void pool_standing(const SlabImage& image);

  std::array<Level, kTop + 1> levels_;
  std::array<std::vector<std::uint8_t>, kTop + 1> scores_;  // that of level 0 is the image's
  std::array<std::vector<std::uint8_t>, 2> standing_;       // of kStandingLevel and the one above
  std::array<std::size_t, 2> standing_pitch_{};
};

}  // namespace isobar
