// SPDX-License-Identifier: BSD-3-Clause
// A horizontal slab of a map seen from above: where walls stand, and where the robot may.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/place/structure_map.hpp"

namespace isobar {

/// Height of base_link in the map frame, and its standard deviation [m].
struct SlabHeight {
  double z_m = 0.0;
  double sigma_m = 0.1;
};

/// Positions of the robot that matter [m, map frame]; the whole map by default.
struct SlabWindow {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
};

/// Image of a slab, row by row, x fastest. A border as wide as the range of a scan lies around all positions of the
/// robot, so that look-ups need no check of bounds. 3 bytes a cell.
class SlabImage {
 public:
  /// Score of a point in a cell with a wall; less beside one.
  static constexpr std::uint8_t kFullScore = 200;
  static constexpr std::uint8_t kBesideScore = 120;
  static constexpr std::uint8_t kDiagonalScore = 80;
  /// Cells of border on each side: kPlaceRangeM and the largest displacement of a bound (SlabPyramid).
  static constexpr int kBorder = 176;
  /// Upper bound of the cells: 2.5 km x 1 km. A window is needed beyond.
  static constexpr std::size_t kMostCells = 64'000'000;

  /// Rebuilds the image of the slab at `height`. O(voxels + cells). False, and an empty image, if nothing of the map is in
  /// the slab, or the image would have more than kMostCells.
  bool build(const StructureMap& map, const SlabHeight& height, const SlabWindow& window = {});

  [[nodiscard]] bool empty() const { return width_ == 0; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Cell index (place_cell()) of column 0 and row 0.
  [[nodiscard]] int first_x() const { return first_x_; }
  [[nodiscard]] int first_y() const { return first_y_; }

  /// Score of a wall, 0 … kFullScore.
  [[nodiscard]] const std::vector<std::uint8_t>& scores() const { return scores_; }
  /// Cells with kFullScore, as indices in scores().
  [[nodiscard]] const std::vector<std::uint32_t>& walls() const { return marked_; }
  /// Blocks of kStandingCells x kStandingCells cells, row by row. 1: the robot may stand here: there is ground near its
  /// height, or in a block beside.
  [[nodiscard]] const std::vector<std::uint8_t>& standing() const { return standing_; }
  static constexpr int kStandingCells = 4;
  /// Levels (height_bit()) of the walls in a cell.
  [[nodiscard]] std::uint16_t walls_at(int column, int row) const {
    if (column < 0 || row < 0 || column >= width_ || row >= height_) return 0;
    return walls_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)];
  }

 private:
  struct SlabBand;
  bool set_extent(const StructureMap& map, const SlabBand& band, const SlabWindow& window);
  void draw(const StructureMap& map, const SlabBand& band);
  void draw_scores();
  void mark_standing(int column, int row);
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column);
  }

  int width_ = 0;
  int height_ = 0;
  int first_x_ = 0;
  int first_y_ = 0;
  std::vector<std::uint8_t> scores_;
  std::vector<std::uint8_t> standing_;
  std::vector<std::uint16_t> walls_;
  std::vector<std::uint32_t> marked_;  // cells with a wall that the search compares
};

}  // namespace isobar
