// SPDX-License-Identifier: BSD-3-Clause
#include "core/map/map_tile.hpp"

#include <utility>

namespace isobar {

void MapTile::publish() {
  auto next = std::make_shared<PlaneTile>();
  next->key = key_;
  for (std::size_t i = 0; i < kBlocksPerTile; ++i) {
    if (blocks_[i] != nullptr && blocks_[i]->planes() != nullptr) {
      next->blocks[i] = blocks_[i]->planes();
      next->plane_count += next->blocks[i]->planes.size();
    }
  }
  planes_ = std::move(next);
}

std::size_t MapTile::cell_count() const {
  std::size_t count = 0;
  for (const auto& block : blocks_) {
    count += block != nullptr ? block->cells().size() : 0;
  }
  return count;
}
}  // namespace isobar
