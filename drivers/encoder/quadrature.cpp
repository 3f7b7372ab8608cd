// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/encoder/quadrature.hpp"

#include <algorithm>

namespace isobar::encoder {

void QuadratureDecoder::start(bool a, bool b) noexcept {
  level_ = {a, b};
  others_ = {};
}

void QuadratureDecoder::add(const Edge& edge) noexcept {
  const auto line = static_cast<std::size_t>(edge.line);
  const std::size_t other = 1 - line;
  ++counters_.edges;
  // Forward, A takes the level that B has not, and B the one that A has.
  const bool follows = edge.rising == level_[other];
  const int direction = follows == (edge.line == Line::kB) ? 1 : -1;
  if (level_[line] == edge.rising) {
    ++counters_.lost;
    restore(line, direction);
  }
  count_ += direction;
  level_[line] = edge.rising;
  others_[line] = 0;
  ++others_[other];
}

/// @param direction of the edge that shows the loss
void QuadratureDecoder::restore(std::size_t line, int direction) noexcept {
  if (others_[line] == 0) {
    count_ -= direction;  // the lost edge and this one were there and back
    ++counters_.restored;
  } else if (others_[line] == 2) {
    // One more, and the other line's second edge, after the lost one, was counted the wrong way.
    count_ += direction + 2 * direction;
    ++counters_.restored;
  }
}

bool EdgeSorter::add(const Edge& edge) noexcept {
  if (size_ == kCapacity) return false;
  auto* const end = edges_.data() + size_;
  // Edges come nearly in order: the place is found from the end.
  auto* place = end;
  while (place != edges_.data() && (place - 1)->stamp_ns > edge.stamp_ns) --place;
  std::move_backward(place, end, end + 1);
  *place = edge;
  ++size_;
  return true;
}

void EdgeSorter::remove_first(std::size_t count) noexcept {
  std::move(edges_.data() + count, edges_.data() + size_, edges_.data());
  size_ -= count;
}

}  // namespace isobar::encoder
