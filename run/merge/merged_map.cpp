// SPDX-License-Identifier: BSD-3-Clause
#include "run/merge/merged_map.hpp"

#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "core/merge/later_session.hpp"
#include "run/files/checkpoint.hpp"
#include "run/files/part_file.hpp"
#include "run/files/run_layout.hpp"
#include "run/floors/floor_names.hpp"
#include "run/floors/stored_floors.hpp"
#include "run/merge/height_relation.hpp"
#include "run/text/tum_row.hpp"

namespace isobar::files {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostBytes = 1'000'000'000'000;  // as TileStoreLimits: what is merged is kept

/// "DIR/" is the folder DIR.
fs::path part_of(const fs::path& out) {
  const fs::path whole = out.has_filename() ? out : out.parent_path();
  return whole.string() + ".part";
}

void check(const std::error_code& error, const fs::path& file) {
  if (error) throw ServiceError(file.string() + ": cannot be written: " + error.message());
}

/// Files of A beside its tiles that hold for the merged map, too.
bool goes_over(const fs::directory_entry& entry) {
  const fs::path& file = entry.path();
  return entry.is_regular_file() && !is_of_tiles(file) && file.extension() != ".part";
}

}  // namespace

/// Key scans on their way into the map.
struct MergedMap::Laying {
  const MergedBuilding& merged;
  BuildingStorage& scans;
  const std::function<void(double)>& progress;
  MergeReport& report;
  std::unique_ptr<RegisteredScan> scan = std::make_unique<RegisteredScan>();
};

MergedMap::MergedMap(const fs::path& out, const MapHeader& header) : out_(out), part_(part_of(out)) {
  std::error_code error;
  if (fs::exists(part_, error)) {
    finished_ = true;  // it is not this one's
    throw UsageError(part_.string() + ": is there already, left by an interrupted merge: delete it");
  }
  fs::create_directories(part_, error);
  check(error, part_);
  tiles_ = FileTileStore::create(part_ / kMapDirectory, header, {.max_bytes = kMostBytes});
  building_ = BuildingStore::open_to_continue(part_ / kMapDirectory, kMostBytes);
}

MergedMap::~MergedMap() {
  if (finished_) return;
  tiles_.reset();
  building_.reset();
  std::error_code error;
  fs::remove_all(part_, error);
}

void MergedMap::lay(const MergedBuilding& merged, const MergeRequest& request, BuildingStorage& scans,
                    const std::function<void(double)>& progress, MergeReport& report) {
  Laying laying{merged, scans, progress, report};
  const StoredBuilding& building = merged.joined.building;
  const std::size_t first_of_b = merged.joined.submaps_of_a;
  LocalMap first(report.map, request.a.T_base_lidar, tiles_.get());
  lay_side(laying, first, 0, first_of_b);
  LocalMap second(of_later_session(report.map), request.b.T_base_lidar, tiles_.get());
  lay_side(laying, second, first_of_b, building.submaps.size());
  report.gone = second.seen_through_count();
  for (const Loop& loop : building.loops) building_->add_loop(loop);
  check_disk();
  write_trajectory(building.submaps);
  report.tiles = tiles_->tile_count();
}

// A map of its own a side: a robot's rays start at its lidar. The second one finds the tiles of the first as a later session
// does.
void MergedMap::lay_side(Laying& laying, LocalMap& map, std::size_t first, std::size_t end) {
  const std::vector<Submap>& submaps = laying.merged.joined.building.submaps;
  bool begun = false;
  for (std::size_t number = first; number < end; ++number) {
    building_->add_submap(submaps[number]);
    for (const KeyScan& key : submaps[number].keys) {
      if (!begun) map.load_around(key.T_map_base.translation());
      begun = true;
      lay_key(laying, map, number, key);
    }
    laying.progress(static_cast<double>(number + 1) / static_cast<double>(submaps.size()));
    check_disk();
  }
  map.store_all();
}

void MergedMap::lay_key(Laying& laying, LocalMap& map, std::size_t submap, KeyScan key) {
  if (key.scan == kNoScanHandle || !laying.scans.read_scan(key.scan, *laying.scan)) {
    ++laying.report.missing_keys;
    return;
  }
  PoseEstimate& pose = laying.scan->pose;
  pose.session = map.session();
  pose.map_moves = 0;
  pose.stamp_ns = key.stamp_ns;
  pose.T_map_base = key.T_map_base;
  map.update(*laying.scan);
  building_->add_key(submap, key, *laying.scan);
  ++laying.report.keys;
}

void MergedMap::check_disk() const {
  for (const std::string& refusal : {tiles_->counters().first_refusal, building_->counters().first_refusal}) {
    if (!refusal.empty()) throw ServiceError(refusal);
  }
}

// Where both have driven: floors and grids need it.
void MergedMap::write_trajectory(const std::vector<Submap>& submaps) const {
  PartFile file(part_ / kTrajectoryFile);
  file.write("# t x y z qx qy qz qw, T_map_base of the key scans of both runs\n");
  std::string line;
  for (const Submap& submap : submaps) {
    for (const KeyScan& key : submap.keys) {
      line.clear();
      text::append_tum_row({key.stamp_ns, key.T_map_base.translation(),
                            Eigen::Quaterniond(key.T_map_base.linear()).normalized()},
                           line);
      file.write(line);
    }
  }
  file.close();
}

void MergedMap::take_over(const fs::path& map_of_a) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(map_of_a, error)) {
    if (!goes_over(entry)) continue;
    const fs::path to = part_ / kMapDirectory / entry.path().filename();
    fs::copy_file(entry.path(), to, error);
    check(error, to);
  }
  if (auto checkpoint = checkpoint_of_map(map_of_a)) {
    checkpoint->session = 1;
    write_checkpoint(part_ / kMapDirectory / kCheckpointFile, *checkpoint);
  }
  const fs::path settings = run_folder_of(map_of_a) / kSettingsFile;
  if (!fs::exists(settings, error)) return;
  fs::copy_file(settings, part_ / kSettingsFile, error);
  check(error, part_ / kSettingsFile);
}

// B's names by their heights in A; those of A come first.
void MergedMap::name_floors(const MergeRequest& request, const MergeFigures& figures) {
  const FloorNames of_b = FloorNames::read(request.b.map_folder);
  const fs::path map = part_ / kMapDirectory;
  FloorNames names = FloorNames::read(map);
  const StoredFloors found = find_stored_floors(*tiles_, path_of(part_ / kTrajectoryFile));
  for (const Floor& floor : found.floors.floors) {
    Floor in_b = floor;
    in_b.height_m -= figures.T_a_b.translation().z();
    const std::string name = of_b.name_of(in_b);
    if (name.empty() || !names.name_of(floor).empty()) continue;
    try {
      names.set(map, floor, name);
    } catch (const DataError&) {
      // A has given the name to another floor: this one stays without.
    }
  }
}

void MergedMap::finish(const MergeRequest& request, const MergeFigures& figures) {
  take_over(request.a.map_folder);
  name_floors(request, figures);
  if (!building_->sync()) throw ServiceError(part_.string() + ": the disk refuses");
  tiles_.reset();
  building_.reset();
  sync_folder(part_ / kMapDirectory);
  std::error_code error;
  fs::remove(out_, error);  // an empty folder
  fs::rename(part_, out_, error);
  check(error, out_);
  finished_ = true;
}

}  // namespace isobar::files
