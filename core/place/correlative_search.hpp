// SPDX-License-Identifier: BSD-3-Clause
// Where in a slab a scan fits, by x, y and heading: exact branch and bound over all cells and headings of a window.
// Sources: E. Olson, "Real-Time Correlative Scan Matching", ICRA 2009 (the score, and rasters of low resolution as upper
// bounds); Hess et al., ICRA 2016 (branch and bound over them).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/place/place_grid.hpp"
#include "core/place/slab_image.hpp"
#include "core/place/slab_pyramid.hpp"

namespace isobar {

/// Where the robot may be: all that the pyramid says it may stand on, within a box, and an interval of headings.
struct SearchWindow {
  SlabWindow box;
  double yaw_rad = 0.0;                              ///< middle of the headings
  double half_yaw_rad = std::numbers::pi_v<double>;  ///< half of their interval
};

/// What the search looks for, and when it gives up.
struct SearchLimits {
  std::size_t most_hypotheses = 96;
  double least_score = 0.35;          ///< 0 … 1
  double least_share_of_best = 0.85;  ///< of the best score, 0 … 1
  double apart_m = 0.7;     ///< a hypothesis hides worse ones that are nearer than this in x and y, and
  double apart_rad = 0.12;  ///< nearer than this in heading
  /// Nodes times columns, below the coarsest level: bounds the time, 1 ns each.
  std::size_t most_sums = 200'000'000;
};

/// A pose of the query in the slab.
struct SlabPose {
  double x_m = 0.0;  ///< map frame
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double score = 0.0;  ///< mean score of the query's columns, 0 … 1
};

/// Branch and bound, best first. The result is that of an exhaustive search over all cells and headings from which the best
/// is taken again and again, with those that it hides left out, as long as `complete` is true. Time: one addition a column
/// for 16 blocks of 1.6 m x 1.6 m x 2.8 degrees on the coarsest level, and one a column for each node below. Memory is kept
/// between searches. Not thread-safe.
class CorrelativeSearch {
 public:
  /// Finds the best hypotheses, the best first. `columns`: PlaceQuery::columns(), at most PlaceQuery::kMostColumns.
  const std::vector<SlabPose>& find(const SlabImage& image, const SlabPyramid& pyramid,
                                    std::span<const Eigen::Vector2f> columns, const SearchWindow& window,
                                    const SearchLimits& limits);
  /// False if the last find() was ended by SearchLimits::most_sums: there may be better hypotheses.
  [[nodiscard]] bool complete() const { return complete_; }
  /// Nodes of the last find(), without those of the coarsest level.
  [[nodiscard]] std::size_t node_count() const { return nodes_; }

 private:
  // Block of 2^level cells and headings.
  struct Node {
    std::uint32_t bound;
    std::int16_t yaw;
    std::uint8_t level;
    std::int32_t column;
    std::int32_t row;
    friend bool operator<(const Node& a, const Node& b) {
      if (a.bound != b.bound) return a.bound < b.bound;
      if (a.level != b.level) return a.level > b.level;  // leaves first
      if (a.row != b.row) return a.row > b.row;
      return a.column != b.column ? a.column > b.column : a.yaw > b.yaw;
    }
  };
  // Blocks to which the points move, for one block of headings.
  struct Turned {
    std::vector<std::int32_t> offsets;  // of entries
    bool known = false;
  };

  void start(const SlabPyramid& pyramid, std::span<const Eigen::Vector2f> columns, const SearchWindow& window,
             const SearchLimits& limits);
  void add_roots();
  void add_roots_of(int yaw);
  void add_root_lanes(int yaw, int column, int row, int last_column);
  void expand(const Node& node);
  void push(const Node& node);
  [[nodiscard]] std::uint32_t sum_at(int level, int yaw, int column, int row);
  const Turned& turned(int level, int yaw);
  [[nodiscard]] bool yaw_in_window(int level, int yaw) const;
  [[nodiscard]] bool hidden(const Node& node) const;
  [[nodiscard]] SlabPose pose_of(const Node& leaf) const;

  const SlabPyramid* pyramid_ = nullptr;
  std::span<const Eigen::Vector2f> columns_;
  SearchWindow window_;
  SearchLimits limits_;
  int first_x_ = 0;
  int first_y_ = 0;
  int low_column_ = 0;  // window, in cells of the image
  int high_column_ = 0;
  int low_row_ = 0;
  int high_row_ = 0;
  std::uint32_t least_ = 0;  // bound below which nodes are dropped
  std::array<std::vector<Turned>, SlabPyramid::kTop + 1> turned_;
  std::vector<Node> heap_;
  std::vector<SlabPose> found_;
  std::size_t nodes_ = 0;
  bool complete_ = true;
};

}  // namespace isobar
