// SPDX-License-Identifier: BSD-3-Clause
// Serialised tile: TileHeader, then for each block with cells its BlockHeader, MapCells, slots of the planes
// (uint16) and PackedPlanes. Little-endian, as every machine that Isobar runs on; on another one the magic
// number does not match.
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/map/map_tile.hpp"

namespace isobar {

namespace {

constexpr std::uint32_t kMagic = 0x31544249;  // "IBT1"

struct TileHeader {
  std::uint32_t magic = kMagic;
  TileKey key;
  float cell_m = 0.0F;
  std::uint32_t block_count = 0;
};

struct BlockHeader {
  std::uint16_t index = 0;
  std::uint16_t cell_count = 0;
  std::uint16_t plane_count = 0;
  std::uint16_t reserved = 0;
};

class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <typename T>
  void write(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count == 0) return;
    const auto* first = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), first, first + count * sizeof(T));
  }

 private:
  std::vector<std::byte>& bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  // Returns false if fewer than count * sizeof(T) bytes are left.
  template <typename T>
  bool read(T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() / sizeof(T) < count) return false;
    if (count == 0) return true;  // memcpy must not be given the null data() of an empty vector
    std::memcpy(values, bytes_.data(), count * sizeof(T));
    bytes_ = bytes_.subspan(count * sizeof(T));
    return true;
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

bool read_header(ByteReader& reader, TileHeader& header) {
  return reader.read(&header, 1) && header.magic == kMagic && std::isfinite(header.cell_m) &&
         header.cell_m > 0.0F && header.block_count <= kBlocksPerTile;
}

// True if slots ascend and slots and counts are in range.
bool are_valid(const std::vector<MapCell>& cells) {
  int last = -1;
  for (const MapCell& cell : cells) {
    if (cell.slot <= last || cell.slot >= CellMask::kSlots || cell.moments.count() <= 0 ||
        cell.moments.count() > CellMoments::kMostPoints) {
      return false;
    }
    last = cell.slot;
  }
  return true;
}

// Returns false if a plane's slot is out of order or has no cell.
bool read_planes(ByteReader& reader, const std::vector<MapCell>& cells, std::size_t count,
                 std::shared_ptr<const PlaneBlock>& planes) {
  std::vector<std::uint16_t> slots(count);
  auto block = std::make_shared<PlaneBlock>();
  block->planes.resize(count);
  if (!reader.read(slots.data(), count) || !reader.read(block->planes.data(), count)) return false;
  auto cell = cells.begin();
  for (const std::uint16_t slot : slots) {
    while (cell != cells.end() && cell->slot < slot) ++cell;
    if (cell == cells.end() || cell->slot != slot) return false;
    block->mask.mark(slot);
    ++cell;
  }
  block->mask.update_ranks();
  planes = count > 0 ? std::move(block) : nullptr;
  return true;
}

struct StoredBlock {
  std::size_t index = 0;
  std::vector<MapCell> cells;
  std::shared_ptr<const PlaneBlock> planes;
};

std::optional<std::vector<StoredBlock>> read_blocks(std::span<const std::byte> bytes, TileHeader& header) {
  ByteReader reader(bytes);
  if (!read_header(reader, header)) return std::nullopt;
  std::vector<StoredBlock> blocks(header.block_count);
  std::ptrdiff_t last = -1;
  for (StoredBlock& block : blocks) {
    BlockHeader head;
    if (!reader.read(&head, 1) || head.index <= last || head.index >= kBlocksPerTile ||
        head.cell_count > CellMask::kSlots || head.plane_count > head.cell_count) {
      return std::nullopt;
    }
    last = head.index;
    block.index = head.index;
    block.cells.resize(head.cell_count);
    if (!reader.read(block.cells.data(), block.cells.size()) || !are_valid(block.cells) ||
        !read_planes(reader, block.cells, head.plane_count, block.planes)) {
      return std::nullopt;
    }
  }
  if (!reader.at_end()) return std::nullopt;
  return blocks;
}

}  // namespace

void MapTile::store(float cell_m, std::vector<std::byte>& bytes) const {
  bytes.clear();
  TileHeader header;
  header.key = key_;
  header.cell_m = cell_m;
  for (const auto& block : blocks_) {
    header.block_count += block != nullptr && !block->cells().empty() ? 1 : 0;
  }
  ByteWriter writer(bytes);
  writer.write(&header, 1);
  for (std::size_t i = 0; i < kBlocksPerTile; ++i) {
    if (blocks_[i] == nullptr || blocks_[i]->cells().empty()) continue;
    const std::vector<MapCell>& cells = blocks_[i]->cells();
    std::vector<std::uint16_t> slots;
    std::vector<PackedPlane> planes;
    for (const MapCell& cell : cells) {
      if (const PackedPlane* plane = blocks_[i]->plane_at(cell.slot)) {
        slots.push_back(cell.slot);
        planes.push_back(*plane);
      }
    }
    const BlockHeader head{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(cells.size()),
                           static_cast<std::uint16_t>(planes.size()), 0};
    writer.write(&head, 1);
    writer.write(cells.data(), cells.size());
    writer.write(slots.data(), slots.size());
    writer.write(planes.data(), planes.size());
  }
}

bool MapTile::restore(std::span<const std::byte> bytes, float cell_m) {
  TileHeader header;
  auto blocks = read_blocks(bytes, header);
  if (!blocks || header.key != key_ || header.cell_m != cell_m) {
    return false;
  }
  for (StoredBlock& stored : *blocks) {
    block_or_add(stored.index).restore(std::move(stored.cells), std::move(stored.planes));
  }
  planes_ = nullptr;
  return true;
}

bool MapTile::append_stored_points(std::span<const std::byte> bytes, std::vector<MapPoint>& points) {
  TileHeader header;
  auto blocks = read_blocks(bytes, header);
  if (!blocks) {
    return false;
  }
  MapTile tile(header.key);
  for (StoredBlock& stored : *blocks) {
    tile.block_or_add(stored.index).restore(std::move(stored.cells), std::move(stored.planes));
  }
  tile.append_points(header.cell_m, points);
  return true;
}

}  // namespace isobar
