// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/voxel_filter.hpp"

#include <algorithm>
#include <bit>

namespace isobar {

namespace {

constexpr std::size_t kFewestSlots = 1024;  // 4 kB

// Fibonacci hashing: multiplication by the golden ratio (Knuth, volume 3, 6.4).
std::uint64_t hash_of(std::uint64_t voxel) {
  const std::uint64_t product = voxel * 0x9E3779B97F4A7C15ULL;
  return product ^ product >> 32U;
}

}  // namespace

VoxelGrid::VoxelGrid(float edge_m)
    : voxels_per_m_(1.0F / std::max(edge_m, 2.0F * kReachM / static_cast<float>(1U << kBitsPerAxis))) {}

VoxelFilter::VoxelFilter(std::size_t max_voxels)
    : table_(std::max(std::bit_ceil(2 * max_voxels), kFewestSlots)),
      max_voxels_(std::min(max_voxels, (std::size_t{1} << (32U - kTagBits)) - 1)) {
  voxels_.reserve(max_voxels_);
  slot_mask_ = kFewestSlots - 1;
}

void VoxelFilter::start() {
  // Table of the size that the last pass needed; grows on demand.
  const std::size_t slots = std::max(std::bit_ceil(2 * voxels_.size()), kFewestSlots);
  voxels_.clear();
  resize(std::min(slots, table_.size()));
}

void VoxelFilter::resize(std::size_t slots) {
  slot_mask_ = slots - 1;
  std::fill_n(table_.begin(), slots, 0U);
  for (std::size_t place = 0; place < voxels_.size(); ++place) {
    insert(voxels_[place], place);
  }
}

void VoxelFilter::insert(std::uint64_t voxel, std::size_t place) {
  const std::uint64_t hash = hash_of(voxel);
  std::size_t slot = hash >> kTagBits & slot_mask_;
  while (table_[slot] != 0) {
    slot = (slot + 1) & slot_mask_;
  }
  const std::uint64_t tag = hash & ((1U << kTagBits) - 1);
  table_[slot] = static_cast<std::uint32_t>((place + 1) << kTagBits | tag);
}

bool VoxelFilter::first(std::uint64_t voxel) {
  constexpr std::uint32_t kTagMask = (1U << kTagBits) - 1;
  const std::uint64_t hash = hash_of(voxel);
  const std::uint32_t tag = static_cast<std::uint32_t>(hash) & kTagMask;
  for (std::size_t slot = hash >> kTagBits & slot_mask_; table_[slot] != 0; slot = (slot + 1) & slot_mask_) {
    const std::uint32_t entry = table_[slot];
    if ((entry & kTagMask) == tag && voxels_[(entry >> kTagBits) - 1] == voxel) {
      return false;
    }
  }
  if (voxels_.size() == max_voxels_) {
    return false;
  }
  if (2 * (voxels_.size() + 1) > slot_mask_ + 1) {
    resize(2 * (slot_mask_ + 1));
  }
  insert(voxel, voxels_.size());
  voxels_.push_back(voxel);
  return true;
}

}  // namespace isobar
