// SPDX-License-Identifier: BSD-3-Clause
// Write-ahead log of the map: the scans that entered it and may not be in the stored tiles yet.
//
// Tiles are large and change with every scan, so they are written every few seconds; a scan is small and is
// written at once. A start after a crash reads the tiles and inserts the scans again.
//
//   NNNNNNNN.scans  part: consecutive records, each a scan (scan_record.hpp)
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <vector>

#include "core/estimates.hpp"
#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// Journal in the folder of a map. One thread, which holds the map's lock.
class ScanJournal {
 public:
  /// Distance [m] and angle [rad] between two scans of the journal: close enough that the planes that a robot
  /// has just seen for the first time are there, far enough that a robot that stands writes nothing.
  static constexpr double kStepM = 0.5;
  static constexpr double kStepRad = 0.26;
  /// Size of all parts at which the oldest is removed, whatever the tiles do [bytes].
  static constexpr std::uint64_t kMaxBytes = 32U << 20;

  /// Continues the journal in the folder: earlier parts stay until their scans are in the tiles.
  explicit ScanJournal(std::filesystem::path directory);

  /// Appends a scan that the map has taken, unless it is close to the last one. A scan that the disk refuses is
  /// left out as a whole.
  void add(const RegisteredScan& scan) noexcept;

  /// A sweep over the changed tiles begins, which will write what the scans up to now have changed. Begins a new
  /// part. `whole`: the sweep before wrote every tile of its; the scans before it are then in the tiles, and
  /// their parts are removed by the next call: the disk may still be writing the tiles.
  void begin_sweep(bool whole) noexcept;

  /// All scans are in the tiles, and these are on the disk: removes all parts.
  void clear() noexcept;

  /// The newest part, for a thread that waits until it is on the disk; none when nothing was written since the
  /// last call.
  [[nodiscard]] FileDescriptor newest_file();
  /// Size of all parts [bytes].
  [[nodiscard]] std::uint64_t disk_bytes() const;

  /// Reads the scans of a folder in their order; those behind a damaged or cut record of a part are left out.
  /// `visit` may keep nothing of its argument.
  /// @return number of scans
  static std::size_t read(const std::filesystem::path& directory,
                          const std::function<void(const RegisteredScan&)>& visit);

 private:
  struct Part {
    std::uint32_t number = 0;
    std::uint64_t bytes = 0;
  };
  [[nodiscard]] bool wants(const PoseEstimate& pose) const;
  [[nodiscard]] bool open_part() noexcept;
  void remove_oldest() noexcept;

  std::filesystem::path directory_;
  std::deque<Part> parts_;  ///< the last one is written, if file_ is open
  FileDescriptor file_;
  std::uint32_t next_number_ = 0;
  std::uint32_t mark_ = 0;      ///< parts before this number were written before the last begin_sweep()
  std::uint32_t in_tiles_ = 0;  ///< parts before this number are in the tiles
  bool unsynced_ = false;
  bool started_ = false;
  PoseEstimate last_pose_;
  std::vector<std::byte> record_;  ///< scratch
};

}  // namespace isobar
