// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/silent_directions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isobar {

namespace {

constexpr float kSilentPixelRad = 2.0F * std::numbers::pi_v<float> / RangeImage::kColumns;
// Largest standard deviation of the elevations of a ring: 0.6 degrees, a third of a pixel.
constexpr float kMaxScatter = 0.0105F;
// Silence proves nothing about things farther away than this [m]: they return from some firings only.
constexpr float kLargestReachM = 15.0F;
// Share of the pixels with a return that must lie beyond the reach.
constexpr float kShareBeyondReach = 0.05F;

constexpr std::size_t kColumnCount = RangeImage::kColumns;
using ColumnSet = std::bitset<kColumnCount>;

// Columns turned by `count`; azimuth wraps around.
ColumnSet turned(const ColumnSet& columns, std::size_t count) {
  return columns << count | columns >> (kColumnCount - count);
}

// Columns and at least `size` neighbours on either side, by doubling; `size`: a power of two.
ColumnSet widened(ColumnSet columns, std::size_t size) {
  for (std::size_t step = 1; step <= size; step *= 2) {
    columns |= turned(columns, step) | turned(columns, kColumnCount - step);
  }
  return columns;
}

// Largest range, in whole metres, beyond which enough of the returns lie.
float reach_of(const RangeImage& image) {
  std::array<int, static_cast<std::size_t>(kLargestReachM) + 1> beyond{};
  int count = 0;
  for (const float range_m : image.range_m) {
    if (std::isinf(range_m)) continue;
    ++count;
    ++beyond[static_cast<std::size_t>(std::min(range_m, kLargestReachM))];
  }
  auto reach = static_cast<int>(kLargestReachM);
  int sum = beyond[static_cast<std::size_t>(reach)];
  while (reach > 0 && static_cast<float>(sum) < kShareBeyondReach * static_cast<float>(count)) {
    sum += beyond[static_cast<std::size_t>(--reach)];
  }
  return static_cast<float>(reach);
}

}  // namespace

float RingScatter::variance() const {
  float count = 0.0F;
  float squares = 0.0F;
  for (const Ring& ring : rings_) {
    if (!(ring.count > 1.0F)) continue;
    count += ring.count;
    squares += std::max(0.0F, ring.squares - ring.sum * ring.sum / ring.count);
  }
  return count > 0.0F ? squares / count : 0.0F;
}

void SilentDirections::set_scan(const RangeImage& image, const RingScatter& scatter, float spacing_m) {
  silent_.reset();
  if (scatter.variance() > kMaxScatter * kMaxScatter) {
    return;  // neither evidence nor knowledge of where the lidar looks
  }
  note_returns(image);
  block_around_near_returns(image, spacing_m);
  reach_m_ = reach_of(image);
  const Row sure = firing_ & turned(firing_, 1) & turned(firing_, kColumnCount - 1);
  for (int row = first_row_; row <= last_row_; ++row) {
    const Row candidates = sure & ~blocked_[static_cast<std::size_t>(row)];
    for (int column = 0; column < RangeImage::kColumns; ++column) {
      const std::size_t at = RangeImage::index_of(column, row);
      silent_[at] =
          candidates[static_cast<std::size_t>(column)] && known_[at] && std::isinf(image.range_m[at]);
    }
  }
}

void SilentDirections::note_returns(const RangeImage& image) {
  firing_.reset();
  for (int row = 0; row < RangeImage::kRows; ++row) {
    for (int column = 0; column < RangeImage::kColumns; ++column) {
      const std::size_t at = RangeImage::index_of(column, row);
      if (std::isinf(image.range_m[at])) continue;
      first_row_ = std::min(first_row_, row);
      last_row_ = std::max(last_row_, row);
      known_.set(at);
      firing_.set(static_cast<std::size_t>(column));
    }
  }
}

// By bands of range: thinning leaves gaps of spacing_m, which are the wider in pixels the nearer the return.
void SilentDirections::block_around_near_returns(const RangeImage& image, float spacing_m) {
  constexpr int kLargestSize = 16;
  blocked_.fill({});
  for (int size = kLargestSize; size > 1; size /= 2) {
    const float from_m =
        size == kLargestSize ? 0.0F : spacing_m / (static_cast<float>(size) * kSilentPixelRad);
    const float to_m = 2.0F * spacing_m / (static_cast<float>(size) * kSilentPixelRad);
    for (int row = first_row_; row <= last_row_; ++row) {
      Row near;
      for (int column = 0; column < RangeImage::kColumns; ++column) {
        const float range_m = image.range_m[RangeImage::index_of(column, row)];
        near[static_cast<std::size_t>(column)] = range_m >= from_m && range_m < to_m;
      }
      if (near.none()) continue;
      near = widened(near, static_cast<std::size_t>(size));
      for (int r = std::max(row - size, 0); r <= std::min(row + size, RangeImage::kRows - 1); ++r) {
        blocked_[static_cast<std::size_t>(r)] |= near;
      }
    }
  }
}

}  // namespace isobar
