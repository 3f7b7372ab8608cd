// SPDX-License-Identifier: BSD-3-Clause
#include "core/place/slab_pyramid.hpp"

#include <algorithm>

namespace isobar {

void SlabPyramid::build(const SlabImage& image) {
  for (int h = 0; h <= kTop; ++h) {
    Level& level = levels_[static_cast<std::size_t>(h)];
    level.width = image.width() >> h;
    level.height = image.height() >> h;
    // The lanes of the search may end in the next row, and behind the last one.
    level.pitch = static_cast<std::size_t>(level.width) + (h == 0 ? 0 : kLanes);
    if (h == 0) {
      level.scores = image.scores().data();
    } else {
      pool_scores(image, h);
    }
  }
  pool_standing(image);
}

// From the walls, which are few: each raises the entries in reach of it.
void SlabPyramid::pool_scores(const SlabImage& image, int h) {
  Level& level = levels_[static_cast<std::size_t>(h)];
  std::vector<std::uint8_t>& scores = scores_[static_cast<std::size_t>(h)];
  scores.assign(level.pitch * static_cast<std::size_t>(level.height) + kLanes, 0);
  level.scores = scores.data();
  const auto width = static_cast<std::uint32_t>(image.width());
  for (const std::uint32_t at : image.walls()) {
    const auto column = static_cast<int>(at % width);
    const auto row = static_cast<int>(at / width);
    raise(scores, h, column, row, 1, SlabImage::kBesideScore);
    raise(scores, h, column, row, 0, SlabImage::kFullScore);
  }
}

// Raises the entries in reach of the cells up to `beside` from one: s (i + 2) - 2 + d >= cell - beside and
// s i - d <= cell + beside along each axis.
void SlabPyramid::raise(std::vector<std::uint8_t>& scores, int h, int column, int row, int beside,
                        std::uint8_t score) const {
  const Level& level = levels_[static_cast<std::size_t>(h)];
  const int stride = 1 << h;
  const int reach = stride / 2;
  const int least = beside + 2 * stride - 2 + reach - (stride - 1);  // rounds the division up
  const int low_column = std::max((column - least) >> h, 0);
  const int high_column = std::min((column + beside + reach) >> h, level.width - 1);
  const int low_row = std::max((row - least) >> h, 0);
  const int high_row = std::min((row + beside + reach) >> h, level.height - 1);
  for (int y = low_row; y <= high_row; ++y) {
    std::uint8_t* entries = scores.data() + static_cast<std::size_t>(y) * level.pitch;
    for (int x = low_column; x <= high_column; ++x) entries[x] = std::max(entries[x], score);
  }
}

void SlabPyramid::pool_standing(const SlabImage& image) {
  standing_[0] = image.standing();
  const Level& fine = levels_[kStandingLevel];
  const Level& top = levels_[kTop];
  standing_pitch_ = {static_cast<std::size_t>(fine.width), static_cast<std::size_t>(top.width)};
  standing_[1].assign(standing_pitch_[1] * static_cast<std::size_t>(top.height), 0);
  for (std::size_t row = 0; row < static_cast<std::size_t>(top.height); ++row) {
    const std::uint8_t* upper = standing_[0].data() + 2 * row * standing_pitch_[0];
    const std::uint8_t* lower = upper + standing_pitch_[0];
    std::uint8_t* out = standing_[1].data() + row * standing_pitch_[1];
    for (std::size_t i = 0; i < standing_pitch_[1]; ++i) {
      out[i] = static_cast<std::uint8_t>(upper[2 * i] | upper[2 * i + 1] | lower[2 * i] | lower[2 * i + 1]);
    }
  }
}

}  // namespace isobar
