// SPDX-License-Identifier: BSD-3-Clause
// The building of a map frame on the disk, in the folder of its map:
//
//   building/building.log        submaps, key scans, loops (building_log.hpp)
//   building/NNNNNNNN.scans      parts: the points of the key scans (run/tile_store/scan_record.hpp)
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/loops/building_storage.hpp"
#include "run/tile_store/file_descriptor.hpp"
#include "run/tile_store/map_folder.hpp"

namespace isobar {

/// Events since the store was opened.
struct BuildingStoreCounters {
  std::uint64_t refused = 0;  ///< records that the disk refused
  std::string first_refusal;
  std::uint64_t damaged = 0;        ///< scans that could not be read
  std::uint64_t removed_bytes = 0;  ///< of a cut or damaged end of the log, found when it was opened
  std::uint64_t forgotten = 0;      ///< parts removed because of the limit
};

/// Storage of a building. One thread. The named constructors throw; the rest counts errors.
class BuildingStore final : public BuildingStorage {
 public:
  static constexpr std::uint64_t kPartBytes = 32U << 20;

  /// Opens or begins the building of a map, and cuts what a crash left incomplete. What was stored is in stored(). A building
  /// that cannot be begun, as on a full disk, is tried again with each record: see counters().refused.
  /// @param map_folder its folder kBuildingFolder is made where it is missing
  /// @param max_bytes of all parts; beyond it the oldest is removed
  /// @throws DataError for a log of another format, or a file that is not a log
  /// @throws ServiceError when the disk refuses, or another process writes the building
  [[nodiscard]] static std::unique_ptr<BuildingStore> open_to_continue(
      const std::filesystem::path& map_folder, std::uint64_t max_bytes);
  /// Opens a building read-only.
  /// @return null where the map has none
  /// @throws DataError, ServiceError as above
  [[nodiscard]] static std::unique_ptr<BuildingStore> open_to_read(const std::filesystem::path& map_folder);

  /// What was on the disk when the store was opened; to be moved from.
  [[nodiscard]] StoredBuilding& stored() { return stored_; }
  [[nodiscard]] const BuildingStoreCounters& counters() const { return counters_; }

  void add_submap(const Submap& submap) override;
  void add_key(std::size_t submap, KeyScan& key, const RegisteredScan& scan) override;
  void add_loop(const Loop& loop) override;
  void add_move(std::int64_t stamp_ns) override;
  bool read_scan(ScanHandle handle, RegisteredScan& out) override;
  /// Waits until everything is on the disk. False where the disk refuses.
  bool sync() noexcept;

 private:
  explicit BuildingStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  bool make_files();
  [[nodiscard]] bool begin_late();
  void load();
  void append_log();
  bool append(const FileDescriptor& file, std::uint64_t& size, const std::vector<std::byte>& bytes);
  [[nodiscard]] ScanHandle append_scan(const RegisteredScan& scan);
  bool open_part();
  void refuse(const std::string& why);

  std::filesystem::path folder_;
  std::uint64_t max_bytes_ = 0;  // 0: read-only
  std::unique_ptr<MapLock> lock_;
  FileDescriptor log_;
  std::uint64_t log_bytes_ = 0;
  std::map<std::uint32_t, std::uint64_t> parts_;  // number and size
  FileDescriptor part_;                           // the newest, to be written; none yet
  FileDescriptor reading_;                        // the part that was read last
  std::uint32_t reading_number_ = 0;
  StoredBuilding stored_;
  BuildingStoreCounters counters_;
  std::vector<std::byte> waiting_;        // for the log, format included, since the disk has refused it
  std::vector<std::byte> record_;         // scratch
  std::vector<std::byte> reading_bytes_;  // scratch
};

}  // namespace isobar
