// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/recording/recording_writer.hpp"
#include "tools/import/request.hpp"

namespace isobar::tools {

/// Files of one scan each, in the order of time.
struct ScanFiles {
  struct Scan {
    std::filesystem::path file;
    std::int64_t stamp_ns = 0;
  };
  std::vector<Scan> scans;
  std::string type;            ///< "PCD", "PLY", "KITTI"
  std::string timing;          ///< where the stamps are from, for a note
  std::filesystem::path oxts;  ///< folder of a KITTI raw recording's IMU; empty: none
};

/// Whether a source is a file of points, or a folder that holds such files, also as KITTI lays them.
[[nodiscard]] bool holds_scans(const std::filesystem::path& source);

/// Finds the files and their times: of times.txt or timestamps.txt, else of the names, else by --rate; of a lidar alone, else 10
/// a second.
/// @throws UsageError naming --rate where nothing tells them and logs come beside the scans; DataError for a file of times that does not fit
[[nodiscard]] ScanFiles find_scans(const ImportRequest& request);

/// Stamp in a name: "1700000000.123456789", "1700000000_123456789", or a count of ns, us or ms since 1970; nothing for
/// any other.
[[nodiscard]] std::optional<std::int64_t> stamp_of_name(const std::string& stem);

/// Writes the scans as clouds; files that cannot be read are left out and said.
void write_scans(const ScanFiles& files, recording::RecordingWriter& writer, ImportReport& report,
                 const std::function<void(double)>& progress);

/// Samples of KITTI's oxts: accelerations and rates (fields 11 to 13 and 17 to 19).
[[nodiscard]] std::vector<ImuSample> read_oxts(const std::filesystem::path& folder);

}  // namespace isobar::tools
