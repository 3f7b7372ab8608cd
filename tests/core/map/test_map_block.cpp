// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/map/cell_mask.hpp"
#include "core/map/cell_moments.hpp"
#include "core/map/map_tile.hpp"
#include "tests/core/map/point_moments.hpp"

namespace isobar::test::test_map_block {

namespace {

using isobar::CellIndex;
using isobar::CellMask;
using isobar::CellMoments;
using isobar::MapBlock;
using isobar::MapCell;
using isobar::MapTile;
using isobar::Moments;
using isobar::PackedPlane;
using isobar::SlotSet;

constexpr float kCellM = 0.25F;

MapBlock::Observation observation_at(const Eigen::Vector3f& fraction) {
  return {fraction, Eigen::Vector3f::UnitX(), 40, 80};
}

SlotSet all_slots() {
  SlotSet all;
  all.words.fill(~std::uint64_t{0});
  return all;
}

// Tile with a few hundred cells, two thirds of which have planes.
MapTile random_tile(std::mt19937& random) {
  MapTile tile({-3, 5, 0});
  std::uniform_int_distribution<int> block(0, 9);
  std::uniform_int_distribution<int> place(0, isobar::kPlacesPerBlock - 1);
  std::uniform_real_distribution<float> fraction(0.0F, 1.0F);
  for (int i = 0; i < 3000; ++i) {
    MapBlock& in = tile.block_or_add(static_cast<std::size_t>(block(random)));
    in.observe(place(random) / 8, observation_at({fraction(random), fraction(random), fraction(random)}));
  }
  std::vector<PackedPlane> scratch;
  for (std::size_t i = 0; i < 10; ++i) {
    const auto two_thirds = [&](const MapCell& cell, PackedPlane& plane) {
      plane = PackedPlane::of({0.1F, 0.2F, fraction(random)}, Eigen::Vector3f::UnitX(), kCellM);
      return cell.slot % 3 != 0;
    };
    tile.block_or_add(i).refit(all_slots(), two_thirds, scratch);
  }
  tile.publish();
  return tile;
}

std::size_t memory_bytes_of(const MapTile& tile) {
  std::size_t bytes = sizeof(MapTile) + sizeof(isobar::PlaneTile);
  for (std::size_t i = 0; i < isobar::kBlocksPerTile; ++i) {
    const MapBlock* block = tile.block(i);
    if (block == nullptr) continue;
    bytes += sizeof(MapBlock) + block->cells().capacity() * sizeof(MapCell);
    if (block->planes() == nullptr) continue;
    bytes += sizeof(isobar::PlaneBlock) + block->planes()->planes.capacity() * sizeof(PackedPlane);
  }
  return bytes;
}

std::vector<std::byte> bytes_of(const MapTile& tile) {
  std::vector<std::byte> bytes;
  tile.store(kCellM, bytes);
  return bytes;
}

}  // namespace

TEST_CASE("tile, block and place identify each cell uniquely, on both sides of the origin") {
  std::set<std::array<int, 5>> names;
  for (int x = -40; x < 40; x += 3) {
    for (int y = -33; y < 40; y += 7) {
      for (int z = -20; z < 40; z += 5) {
        const CellIndex cell(x, y, z);
        const isobar::TileKey key = isobar::tile_of(cell);
        const std::size_t block = isobar::block_of(cell);
        const int place = isobar::place_of(cell);
        CHECK(isobar::first_cell(key, block) + isobar::offset_of(place) == cell);
        CHECK(isobar::first_of_block(cell) == isobar::first_cell(key, block));
        names.insert({key.x, key.y, key.z, static_cast<int>(block), place});
      }
    }
  }
  CHECK(names.size() == 27 * 11 * 12);
}

TEST_CASE("floor_int equals std::floor, also at integers") {
  for (const double value : {-3.0, -2.5, -1e-9, 0.0, 0.999, 1.0, 41.5, -41.5}) {
    CHECK(isobar::floor_int(value) == static_cast<int>(std::floor(value)));
  }
}

TEST_CASE("the rank of a slot is the number of members below it") {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> slot(0, CellMask::kSlots - 1);
  CellMask mask;
  std::set<int> members;
  for (int i = 0; i < 600; ++i) {
    const int s = slot(random);
    if (i % 4 == 3) {
      mask.erase(s);
      members.erase(s);
    } else {
      mask.insert(s);
      members.insert(s);
    }
    const int probe = slot(random);
    CHECK(mask.has(probe) == members.contains(probe));
    CHECK(mask.rank(probe) ==
          static_cast<std::size_t>(std::distance(members.begin(), members.lower_bound(probe))));
  }
}

TEST_CASE("a box of cells across blocks visits each member in it once, and no other cell") {
  std::mt19937 random(31);
  std::uniform_int_distribution<int> coordinate(-20, 20);
  std::uniform_int_distribution<int> size(0, 11);
  for (int i = 0; i < 200; ++i) {
    const CellIndex first(coordinate(random), coordinate(random), coordinate(random));
    const CellIndex last = first + CellIndex(size(random), size(random), size(random));
    // Cells are members if the sum of their indices is a multiple of three.
    const auto is_member = [](const CellIndex& cell) { return (cell.x() + cell.y() + cell.z()) % 3 == 0; };
    std::set<std::array<int, 3>> visited;
    int visits = 0;
    isobar::for_each_block(first, last,
                           [&](const CellIndex& block, const CellIndex& low, const CellIndex& high) {
                             CellMask mask;
                             for (int place = 0; place < isobar::kPlacesPerBlock; ++place) {
                               if (is_member(block + isobar::offset_of(place))) mask.mark(place);
                             }
                             mask.update_ranks();
                             isobar::for_each_in_window(mask, 0, low, high, [&](int slot) {
                               const CellIndex cell = block + isobar::offset_of(slot);
                               visited.insert({cell.x(), cell.y(), cell.z()});
                               ++visits;
                             });
                           });
    std::set<std::array<int, 3>> expected;
    for (int x = first.x(); x <= last.x(); ++x) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int z = first.z(); z <= last.z(); ++z) {
          if (is_member({x, y, z})) expected.insert({x, y, z});
        }
      }
    }
    CHECK(visited == expected);
    CHECK(visits == static_cast<int>(expected.size()));
  }
}

TEST_CASE("fixed-point moments agree with the points to their resolution, in any order of points") {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> fraction(0.0F, 1.0F);
  std::vector<Eigen::Vector3f> points(CellMoments::kMostPoints);
  Moments exact;
  for (Eigen::Vector3f& p : points) {
    p = {fraction(random), fraction(random), fraction(random)};
    add_point(exact, (p.array() - 0.5F) * kCellM);
  }
  CellMoments forward;
  CellMoments backward;
  for (const Eigen::Vector3f& p : points) forward.add(p);
  std::reverse(points.begin(), points.end());
  for (const Eigen::Vector3f& p : points) backward.add(p);
  CHECK(forward.outer == backward.outer);
  CHECK(forward.sum == backward.sum);
  const Moments moments = forward.in_metres(kCellM);
  CHECK(moments.count == exact.count);
  // Rounding moves a point by at most half a unit of 0.5 mm.
  CHECK((mean_of(moments) - mean_of(exact)).cwiseAbs().maxCoeff() < 0.00025F);
  CHECK((moments.outer_diagonal - exact.outer_diagonal).cwiseAbs().maxCoeff() / exact.count <
        2.0F * 0.125F * 0.00025F);
}

TEST_CASE("the sum of the moments of neighbouring cells equals the moments of all their points") {
  std::mt19937 random(41);
  std::uniform_real_distribution<float> fraction(0.0F, 1.0F);
  std::uniform_int_distribution<int> step(-3, 3);
  isobar::MomentSum sum;
  Moments exact;
  for (int cell = 0; cell < 40; ++cell) {
    const Eigen::Vector3i offset(step(random), step(random), step(random));
    CellMoments moments;
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3f p(fraction(random), fraction(random), fraction(random));
      moments.add(p);
      add_point(exact, (p.array() - 0.5F + offset.array().cast<float>()) * kCellM);
    }
    sum.add(moments, offset);
  }
  const Moments moments = sum.in_metres(kCellM);
  CHECK(moments.count == exact.count);
  // Rounding moves a point by at most 0.25 mm, at up to 1 m from the centre.
  CHECK((mean_of(moments) - mean_of(exact)).cwiseAbs().maxCoeff() < 0.00025F);
  CHECK((moments.outer_diagonal - exact.outer_diagonal).cwiseAbs().maxCoeff() / exact.count < 0.0005F);
  CHECK((moments.outer_off_diagonal - exact.outer_off_diagonal).cwiseAbs().maxCoeff() / exact.count <
        0.0005F);
}

TEST_CASE("the moments of a full cell with all points in a corner do not overflow") {
  for (const float corner : {0.0F, 1.0F}) {
    CellMoments moments;
    for (int i = 0; i < 200; ++i) moments.add(Eigen::Vector3f::Constant(corner));
    CHECK(moments.count() == CellMoments::kMostPoints);
    CHECK(moments.mean_m(kCellM).x() == doctest::Approx((corner - 0.5F) * kCellM));
    CHECK(moments.outer[0] == CellMoments::kMostPoints * 256 * 256);
  }
}

TEST_CASE("the moments of a cube of full cells on both sides do not overflow") {
  CellMoments full;
  for (int i = 0; i < CellMoments::kMostPoints; ++i) full.add(Eigen::Vector3f::Ones());
  isobar::MomentSum sum;
  for (int cell = 0; cell < 128; ++cell) sum.add(full, {4, -4, 4});
  const Moments moments = sum.in_metres(kCellM);
  CHECK(moments.count == 128.0F * CellMoments::kMostPoints);
  // All points are at one place, 4.5 and -3.5 cells from the centre: exact except for rounding to float.
  const Eigen::Vector3f place = Eigen::Vector3f(4.5F, -3.5F, 4.5F) * kCellM;
  CHECK((mean_of(moments) - place).norm() < 1e-6F);
  CHECK(moments.outer_diagonal.y() / moments.count == doctest::Approx(place.y() * place.y()));
  CHECK(moments.outer_off_diagonal.z() / moments.count == doctest::Approx(place.y() * place.z()));
}

TEST_CASE("packing a plane changes its point by less than 32 um per axis and its normal by 0.002 degrees") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-1.1F, 1.1F);
  std::normal_distribution<float> direction;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f q(place(random), place(random), place(random));
    const Eigen::Vector3f normal =
        Eigen::Vector3f(direction(random), direction(random), direction(random)).normalized();
    const PackedPlane plane = PackedPlane::of(q, normal, kCellM);
    CHECK((plane.q_block(kCellM) - q).cwiseAbs().maxCoeff() < 3.2e-5F);
    CHECK((plane.unit_normal() - normal).norm() < 3e-5F);
  }
}

TEST_CASE("published planes do not change when the block does") {
  MapBlock block;
  std::vector<PackedPlane> scratch;
  const PackedPlane plane = PackedPlane::of({0.1F, 0.2F, 0.3F}, Eigen::Vector3f::UnitX(), kCellM);
  const auto on_this_side = [&](const MapCell& cell, PackedPlane& fitted) {
    fitted = plane;
    return cell.slot < isobar::kPlacesPerBlock;
  };
  block.observe(77, observation_at({0.5F, 0.5F, 0.5F}));
  CHECK(block.refit(all_slots(), on_this_side, scratch));
  const auto published = block.planes();
  REQUIRE(published->planes.size() == 1);
  CHECK_FALSE(block.refit(all_slots(), on_this_side, scratch));  // the same plane again: nothing changed
  CHECK(block.planes() == published);
  // A point seen from the other side goes to the slot of the other side.
  MapBlock::Observation behind = observation_at({0.5F, 0.5F, 0.5F});
  behind.toward = -behind.toward;
  CHECK(block.observe(77, behind) == 77 + isobar::kPlacesPerBlock);
  CHECK(block.find(77 + isobar::kPlacesPerBlock) != nullptr);
  CHECK(block.refit(
      all_slots(), [](const MapCell&, PackedPlane&) { return false; }, scratch));
  CHECK(block.planes() == nullptr);
  CHECK(published->find(77)->q == plane.q);
}

TEST_CASE(
    "the side of a point depends on the normal of the cell's plane, not on the direction to the first "
    "observer") {
  MapBlock block;
  std::vector<PackedPlane> scratch;
  // First seen along x, whereas the normal is halfway between x and y.
  const Eigen::Vector3f normal = Eigen::Vector3f(1.0F, 1.0F, 0.0F).normalized();
  const auto facing_normal = [&](const MapCell& /*cell*/, PackedPlane& plane) {
    plane = PackedPlane::of({0.1F, 0.2F, 0.3F}, normal, kCellM);
    return true;
  };
  const auto side_seen_along = [&](const Eigen::Vector3f& toward) {
    MapBlock::Observation look = observation_at({0.5F, 0.5F, 0.5F});
    look.toward = toward.normalized();
    block.observe(77, look);
    const MapCell* behind = block.find(77 + isobar::kPlacesPerBlock);
    return behind != nullptr && behind->moments.count() == 1 ? 1 : 0;
  };
  CHECK(side_seen_along({1.0F, 0.0F, 0.0F}) == 0);
  CHECK(side_seen_along({-1.0F, 0.0F, 0.0F}) == 0);  // a cell without a plane has one side
  REQUIRE(block.refit(all_slots(), facing_normal, scratch));
  CHECK(side_seen_along({-0.5F, 1.0F, 0.0F}) == 0);   // opposite to the first observer, in front of the plane
  CHECK(side_seen_along({-1.0F, 0.95F, 0.0F}) == 0);  // grazing
  MapBlock again = block;
  CHECK(side_seen_along({0.5F, -1.0F, 0.0F}) == 1);  // on the first observer's side, behind the plane

  // Files of earlier versions hold the direction to the first observer, and no has_plane.
  std::vector<MapCell> stored = again.cells();
  for (MapCell& cell : stored) {
    cell.set_facing(Eigen::Vector3f::UnitX());
    cell.has_plane = 0;
  }
  block.restore(stored, again.planes());
  CHECK(side_seen_along({-0.5F, 1.0F, 0.0F}) == 0);
  CHECK(side_seen_along({0.5F, -1.0F, 0.0F}) == 1);
}

TEST_CASE("a cell is due for a fit whenever its points have quadrupled, and when it freezes") {
  MapBlock block;
  std::vector<PackedPlane> scratch;
  const auto no_plane = [](const MapCell&, PackedPlane&) { return false; };
  std::vector<int> asked_at;
  for (int count = 1; count <= 100; ++count) {
    if (const int slot = block.observe(300, observation_at({0.5F, 0.5F, 0.5F})); slot != MapBlock::kNoSlot) {
      CHECK(slot == 300);
      asked_at.push_back(count);
      SlotSet waiting;
      waiting.insert(slot);
      CHECK_FALSE(block.refit(waiting, no_plane, scratch));
    }
  }
  CHECK(asked_at == std::vector{1, 4, 16, 64, 80});
}

TEST_CASE("a refit fits the waiting cells, keeps the other planes and drops those of removed cells") {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> place(0, isobar::kPlacesPerBlock - 1);
  std::uniform_int_distribution<int> chance(0, 3);
  MapBlock block;
  std::vector<PackedPlane> scratch;
  std::map<int, PackedPlane> expected;
  for (int round = 0; round < 60; ++round) {
    SlotSet waiting;
    std::set<int> due;
    for (int i = 0; i < 20; ++i) {
      const int at = place(random);
      block.observe(at, observation_at({0.5F, 0.5F, 0.5F}));
      if (chance(random) != 0) {
        waiting.insert(at);
        due.insert(at);
      }
    }
    for (MapCell& cell : block.cells()) {
      cell.seen_through = chance(random) == 0 ? 9 : 0;
      if (cell.seen_through > 0) {
        due.erase(cell.slot);
        expected.erase(cell.slot);
      }
    }
    block.remove_seen_through(5);
    std::set<int> asked;
    const auto fit = [&](const MapCell& cell, PackedPlane& plane) {
      asked.insert(cell.slot);
      const auto q = static_cast<float>(round);
      plane = PackedPlane::of({0.01F * q, 0.0F, 0.0F}, Eigen::Vector3f::UnitX(), kCellM);
      const bool is_plane = (cell.slot + round) % 3 != 0;
      if (is_plane) {
        expected[cell.slot] = plane;
      } else {
        expected.erase(cell.slot);
      }
      return is_plane;
    };
    block.refit(waiting, fit, scratch);
    CHECK(asked == due);
    for (int slot = 0; slot < CellMask::kSlots; ++slot) {
      const PackedPlane* plane = block.plane_at(slot);
      REQUIRE((plane != nullptr) == expected.contains(slot));
      if (plane != nullptr) CHECK(*plane == expected.at(slot));
    }
  }
  CHECK(expected.size() > 20);
}

TEST_CASE("a restored tile equals the stored one and behaves like it from then on") {
  std::mt19937 random(6);
  MapTile tile = random_tile(random);
  const std::vector<std::byte> bytes = bytes_of(tile);
  MapTile back(tile.key());
  REQUIRE(back.restore(bytes, kCellM));
  CHECK(bytes_of(back) == bytes);
  back.publish();
  REQUIRE(back.planes()->plane_count == tile.planes()->plane_count);
  for (int i = 0; i < 200; ++i) {
    const auto observation = observation_at({0.01F * static_cast<float>(i % 90), 0.3F, 0.7F});
    tile.block_or_add(2).observe(i, observation);
    back.block_or_add(2).observe(i, observation);
  }
  CHECK(bytes_of(back) == bytes_of(tile));
  std::vector<isobar::MapPoint> here;
  std::vector<isobar::MapPoint> there;
  tile.append_points(kCellM, here);
  REQUIRE(MapTile::append_stored_points(bytes_of(back), there));
  REQUIRE(here.size() == there.size());
  CHECK(here.size() > 500);
  CHECK(here.back().p_map == there.back().p_map);
}

TEST_CASE("bytes that are truncated, too long, or of another tile or cell size are refused") {
  std::mt19937 random(7);
  const MapTile tile = random_tile(random);
  const std::vector<std::byte> bytes = bytes_of(tile);
  for (std::size_t length = 0; length < bytes.size(); length += 97) {
    MapTile back(tile.key());
    CHECK_FALSE(back.restore(std::span(bytes).first(length), kCellM));
    CHECK(back.cell_count() == 0);
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  CHECK_FALSE(MapTile(tile.key()).restore(longer, kCellM));
  CHECK_FALSE(MapTile({0, 0, 0}).restore(bytes, kCellM));  // another key
  CHECK_FALSE(MapTile(tile.key()).restore(bytes, 0.5F));   // another cell size
}

TEST_CASE("a cell with its plane takes at most 64 bytes of memory") {
  // A wall of 8 x 8 m, as most of a map is.
  MapTile tile({0, 0, 0});
  for (int x = 0; x < isobar::kTileCells; ++x) {
    for (int z = 0; z < isobar::kTileCells; ++z) {
      const CellIndex cell(x, 13, z);
      MapBlock& block = tile.block_or_add(isobar::block_of(cell));
      block.observe(isobar::place_of(cell), observation_at({0.5F, 0.5F, 0.5F}));
    }
  }
  std::vector<PackedPlane> scratch;
  for (std::size_t i = 0; i < isobar::kBlocksPerTile; ++i) {
    const auto wall = [](const MapCell&, PackedPlane& plane) {
      plane = PackedPlane::of({0.0F, 0.0F, 0.0F}, Eigen::Vector3f::UnitY(), kCellM);
      return true;
    };
    if (MapBlock* block = tile.block(i)) block->refit(all_slots(), wall, scratch);
  }
  tile.publish();
  CHECK(memory_bytes_of(tile) <= 64 * tile.cell_count() + 8 * 1024);
  MESSAGE("bytes per cell with a plane, on a wall: " << static_cast<double>(memory_bytes_of(tile)) /
                                                            static_cast<double>(tile.cell_count()));
}

}  // namespace isobar::test::test_map_block
