// SPDX-License-Identifier: BSD-3-Clause
// What a standing robot sees, as the search for its place needs it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isobar {

/// One to ten scans of a standing robot, or the points of a submap. All points are levelled: z up by gravity, origin at
/// base_link, any heading, the same for all. Use: clear(), add() for each scan, finish(). Memory is kept between queries.
/// Not thread-safe.
class PlaceQuery {
 public:
  static constexpr std::size_t kMostColumns = 320;  ///< 320 x SlabImage::kFullScore fits in 16 bits
  static constexpr std::size_t kMostWallPoints = 2400;
  static constexpr std::size_t kMostFreeCells = 3200;
  static constexpr std::size_t kMostSamples = 1500;

  /// Part of the free space that the rays have shown.
  struct FreeCell {
    Eigen::Vector2f p_level;   ///< middle of the cell [m]
    std::uint16_t levels = 0;  ///< at which rays passed, see height_bit()
  };

  /// Points of a scan, and where their rays start.
  struct Scan {
    std::span<const Eigen::Vector3f> p_level;
    Eigen::Vector3f p_level_lidar;
  };

  PlaceQuery();
  void clear();
  /// Adds the points of a scan [m]; points that are not finite, or beyond kViewRangeM, are left out. `p_level_lidar`: where
  /// their rays start. `has_rays`: false for points of a submap, which were not seen from one place.
  void add(std::span<const Eigen::Vector3f> p_level, const Eigen::Vector3f& p_level_lidar,
           bool has_rays = true);
  /// Computes all of the below.
  void finish();

  /// Where walls stand up to kPlaceRangeM, evenly spread over the area.
  [[nodiscard]] std::span<const Eigen::Vector2f> columns() const { return columns_; }
  /// Points of these walls.
  [[nodiscard]] std::span<const Eigen::Vector3f> wall_points() const { return wall_points_; }
  /// Other points of the sample: ground, ceilings, steps, clutter.
  [[nodiscard]] std::span<const Eigen::Vector3f> other_points() const { return other_points_; }
  [[nodiscard]] std::span<const FreeCell> free_cells() const { return free_cells_; }
  /// All kinds of points, at most kMostSamples, evenly spread in space: for the ICP.
  [[nodiscard]] std::span<const Eigen::Vector3f> sample() const { return sample_; }
  [[nodiscard]] const Eigen::Vector3f& p_level_lidar() const { return p_level_lidar_; }
  /// All points that have rays. Valid until the next clear().
  [[nodiscard]] std::vector<Scan> scans() const;
  /// Height of the ground near the robot, from base_link [m]; 0 where none is seen.
  [[nodiscard]] float ground_z_m() const { return ground_z_m_; }
  /// False where so little is seen that no place could be told: an open field, or an incomplete scan.
  [[nodiscard]] bool can_judge() const { return columns_.size() >= kLeastColumns; }

 private:
  static constexpr std::size_t kLeastColumns = 40;
  static constexpr std::size_t kMostRays = 6000;
  struct Column {
    float low_m;
    float high_m;
    std::uint16_t free;
    std::uint8_t state;
  };
  void clear_grid();
  void mark_points();
  void mark_ray(const Eigen::Vector3f& end);
  void block_free_beside_points();
  void collect_columns();
  void collect_wall_points();
  void collect_free_cells();
  void collect_sample();
  void find_ground();

  struct ScanRange {
    std::size_t begin;
    std::size_t end;
    Eigen::Vector3f p_level_lidar;
  };
  std::vector<Eigen::Vector3f> points_;
  std::vector<ScanRange> scans_;
  std::vector<Eigen::Vector3f> ray_ends_;
  Eigen::Vector3f p_level_lidar_ = Eigen::Vector3f::Zero();
  float ground_z_m_ = 0.0F;
  std::vector<Column> grid_;
  std::vector<Eigen::Vector2f> columns_;
  std::vector<Eigen::Vector3f> wall_points_;
  std::vector<Eigen::Vector3f> other_points_;
  std::vector<FreeCell> free_cells_;
  std::vector<Eigen::Vector3f> sample_;
  std::vector<std::uint64_t> voxels_;  // scratch
};

}  // namespace isobar
