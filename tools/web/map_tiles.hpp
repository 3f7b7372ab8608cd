// SPDX-License-Identifier: BSD-3-Clause
// The map for viewers: points in cubes of space, quantised, with the number of the change that each cube had last, so that
// a viewer fetches what is new to it and the server remembers nothing of viewers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace isobar::web {

/// A point in its cube: x, y, z in steps from the corner, and intensity.
using TilePoint = std::array<std::uint16_t, 4>;
/// Cube number along x, y, z of the map frame.
using TileIndex = std::array<std::int32_t, 3>;

inline constexpr double kTileStepM = 0.00025;
inline constexpr double kTileEdgeM = 65'536 * kTileStepM;  ///< 16.384 m

/// A whole map under construction.
class MapDraft {
 public:
  /// Points beyond these are counted and left out: 48 MB.
  static constexpr std::size_t kMostPoints = 6'000'000;
  /// Coordinates beyond this are refused [m].
  static constexpr double kFarthestM = 1e6;

  /// Takes a point of the map frame. One that is not finite or absurdly far is left out.
  void add(double x_m, double y_m, double z_m, std::uint8_t intensity);

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  friend class MapTiles;
  struct Tile {
    std::vector<TilePoint> points;
    std::uint64_t sum = 0;  ///< of a hash of each point: equal for equal points in any order
  };
  std::map<TileIndex, Tile> tiles_;
  TileIndex last_index_{};
  Tile* last_tile_ = nullptr;  ///< of tiles_, whose places stay: points mostly come cube by cube
  std::size_t points_ = 0;
  std::uint64_t left_out_ = 0;
};

/// What a viewer is told about the map.
struct MapState {
  std::uint32_t epoch = 0;   ///< another number: another map frame, or another server
  std::uint32_t change = 0;  ///< number of the newest change
  std::uint64_t points = 0;
  std::uint64_t left_out = 0;  ///< points for want of memory
};

/// Any thread.
class MapTiles {
 public:
  /// Bytes of an answer at which it ends; one cube may go beyond.
  static constexpr std::size_t kAnswerBytes = std::size_t{2} << 20;

  /// @param epoch see MapState; 0 is never used
  explicit MapTiles(std::uint32_t epoch);

  /// Replaces the map. Cubes with equal points keep their change.
  void replace(MapDraft&& draft);
  /// Keeps every n-th point, so that no more than this many remain. The rest counts as left out.
  void thin_to(std::size_t points);
  /// Another map frame: forgets everything.
  void start_over();
  [[nodiscard]] MapState state() const;

  /// The binary answer of /api/map (docs/web.md): cubes with changes after `since` in the order of their changes, as many
  /// as fit; of another epoch, from the beginning. A cube that is empty now has no points.
  [[nodiscard]] std::string changes_since(std::uint32_t epoch, std::uint32_t since,
                                          std::size_t answer_bytes = kAnswerBytes) const;

 private:
  struct Tile {
    std::vector<TilePoint> points;
    std::uint64_t sum = 0;
    std::uint32_t change = 0;
  };
  void set(const TileIndex& index, Tile& tile, std::vector<TilePoint>&& points, std::uint64_t sum);

  mutable std::mutex mutex_;
  MapState state_;
  std::map<TileIndex, Tile> tiles_;
  std::map<std::uint32_t, TileIndex> by_change_;
};

}  // namespace isobar::web
