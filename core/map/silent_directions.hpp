// SPDX-License-Identifier: BSD-3-Clause
// Directions in which a lidar fired and got nothing back: open sky where somebody stood.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace isobar {

/// Range image in the lidar frame, 2 degrees per pixel, row by row: minimum range [m]; infinite without a return.
struct RangeImage {
  static constexpr int kColumns = 180;  ///< azimuth, 360 degrees
  static constexpr int kRows = 90;      ///< elevation, 180 degrees
  static constexpr std::size_t kPixels = static_cast<std::size_t>(kColumns) * kRows;

  std::array<float, kPixels> range_m{};

  [[nodiscard]] static std::size_t index_of(int column, int row) {
    return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
  }
};

/// Scatter of the elevations within a ring: no more than noise, unless the lidar pitched or rolled during the scan (the
/// points of a scan are given in the frame of its end) or the rings are unknown.
class RingScatter {
 public:
  void clear() { rings_.fill({}); }
  /// `sine`: of the elevation.
  void add(std::uint8_t ring, float sine) {
    Ring& of = rings_[ring];
    of.count += 1.0F;
    of.sum += sine;
    of.squares += sine * sine;
  }
  /// Variance of the sines about the mean of their ring.
  [[nodiscard]] float variance() const;

 private:
  struct Ring {
    float count = 0.0F, sum = 0.0F, squares = 0.0F;
  };
  std::array<Ring, 256> rings_{};
};

/// Finds the pixels in which silence is evidence of free space. A scan holds returns only, so the firings without one
/// are inferred. A pixel is silent where
///   - it returns nothing now, but has before: the lidar looks there, and no part of the robot is in the way;
///   - its column and the next ones return something in other rows: no packet is lost there;
///   - no near return is beside it, whose neighbours the thinning of the scan may have removed;
///   - the scan is not bent, see RingScatter.
/// What the eight neighbours return bounds the free range: a black or wet surface flickers, but not all over.
class SilentDirections {
 public:
  /// Notes the returns of a scan. `spacing_m`: largest distance between neighbouring points that thinning leaves.
  void set_scan(const RangeImage& image, const RingScatter& scatter, float spacing_m);

  [[nodiscard]] bool silent(std::size_t pixel) const { return silent_.test(pixel); }
  /// Range up to which silence is evidence [m]. The scan has returns from farther away: neither fog nor dust ends its
  /// rays before.
  [[nodiscard]] float reach_m() const { return reach_m_; }

 private:
  using Mask = std::bitset<RangeImage::kPixels>;
  using Row = std::bitset<RangeImage::kColumns>;
  using Rows = std::array<Row, RangeImage::kRows>;

  void note_returns(const RangeImage& image);
  void block_around_near_returns(const RangeImage& image, float spacing_m);

  Mask known_;                         // has returned something since the start
  Mask silent_;                        // in this scan
  Rows blocked_;                       // near returns and their surroundings, in this scan
  Row firing_;                         // columns in which this scan has returns
  int first_row_ = RangeImage::kRows;  // of known_: no other rows need a look
  int last_row_ = -1;
  float reach_m_ = 0.0F;
};

}  // namespace isobar
