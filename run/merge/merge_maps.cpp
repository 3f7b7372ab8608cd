// SPDX-License-Identifier: BSD-3-Clause
#include "run/merge/merge_maps.hpp"

#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "run/building/building_store.hpp"
#include "run/merge/merged_map.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar::files {

namespace fs = std::filesystem;

namespace {

// Share of the work that laying the map takes.
constexpr double kLayShare = 0.4;

void refuse_bad_folders(const MergeRequest& request) {
  std::error_code error;
  if (fs::equivalent(request.a.map_folder, request.b.map_folder, error)) {
    throw UsageError(request.a.map_folder.string() + ": A and B are the same map");
  }
  const bool empty = !fs::exists(request.out, error) || fs::is_empty(request.out, error);
  if (error || !empty) {
    throw UsageError("--out: " + request.out.string() + " must be a new or an empty folder");
  }
}

/// One side as it is on the disk.
struct OpenSide {
  std::unique_ptr<BuildingStore> store;
  MapHeader header;

  OpenSide(const MergeInput& input, std::vector<std::string>& notes)
      : store(BuildingStore::open_to_read(input.map_folder)), header(read_map_header(input.map_folder)) {
    const std::string name = input.map_folder.string();
    if (!store) {
      throw DataError(name +
                      ": holds tiles alone, no key scans: it was made by an earlier version or with "
                      "loops.enabled = false, and cannot be merged");
    }
    if (store->stored().submaps.empty()) throw DataError(name + ": its building holds no submap yet");
    if (const std::uint64_t bytes = store->counters().removed_bytes; bytes > 0) {
      notes.push_back(name + ": the last " + std::to_string(bytes) +
                      " bytes of its log are cut or damaged, and left out");
    }
  }
};

KnownMap known_map(const MergeInput& input, std::vector<std::string>& notes) {
  const auto tiles = FileTileStore::open_to_read(input.map_folder);
  KnownMap map(static_cast<float>(tiles->header().cell_m));
  std::vector<std::byte> bytes;
  std::size_t unreadable = 0;
  for (const TileKey& key : tiles->keys()) {
    if (!tiles->take(key, bytes) || !map.add_tile(key, bytes)) ++unreadable;
  }
  if (unreadable > 0) {
    notes.push_back(input.map_folder.string() + ": " + std::to_string(unreadable) +
                    " tiles cannot be read; what stands there is laid anew");
  }
  map.finish();
  return map;
}

void note_other_cells(const OpenSide& a, const OpenSide& b, std::vector<std::string>& notes) {
  if (a.header == b.header) return;
  char text[120];  // NOLINT(modernize-avoid-c-arrays)
  std::snprintf(text, sizeof(text), "the cells of B are of %g m: the result has those of A, of %g m",
                b.header.cell_m, a.header.cell_m);
  notes.emplace_back(text);
}

}  // namespace

MergeReport merge_maps(const MergeRequest& request, const std::function<void(double)>& progress) {
  refuse_bad_folders(request);
  MergeReport report;
  OpenSide a(request.a, report.notes);
  OpenSide b(request.b, report.notes);
  note_other_cells(a, b, report.notes);
  MergeSettings settings = request.settings;
  settings.map.cell_m = a.header.cell_m;
  const KnownMap map_a = known_map(request.a, report.notes);
  const MergeSide side_a{std::move(a.store->stored()), *a.store, request.a.T_base_lidar};
  const MergeSide side_b{std::move(b.store->stored()), *b.store, request.b.T_base_lidar};
  report.submaps_a = side_a.building.submaps.size();
  report.submaps_b = side_b.building.submaps.size();
  report.map = settings.map;
  BuildingMerger merger(settings, side_a, map_a, side_b,
                        [&](double share) { progress((1.0 - kLayShare) * share); });
  const MergedBuilding merged = merger.run(request.height);
  report.figures = merged.figures;
  report.problem = merged.problem;
  report.b_later_ns = merged.joined.b_later_ns;
  if (!merged.problem.empty()) return report;
  JoinedScans scans(*a.store, *b.store);
  MergedMap out(request.out, a.header);
  out.lay(
      merged, request, scans, [&](double share) { progress(1.0 - kLayShare * (1.0 - share)); }, report);
  out.finish(request, report.figures);
  return report;
}

}  // namespace isobar::files
