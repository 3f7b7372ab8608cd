// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/run_folder.hpp"

#include <utility>

#include "run/files/ply_reader.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::evaluation {

std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name) {
  enum Column : std::size_t { kStampNs, kMode, kScanMs, kAltimeterHeightM, kSdZM };
  text::CsvReader csv(text::TextLines(text, name), {"t_ns"},
                      {"mode", "scan_ms", "altimeter_height_m", "sd_z_m"});
  std::vector<StatusRow> rows;
  while (csv.next_row()) {
    StatusRow row;
    row.stamp_ns = csv.int64(kStampNs);
    row.mode = csv.field(kMode);
    row.scan_ms = csv.number_or_nan(kScanMs);
    row.altimeter_height_m = csv.number_or_nan(kAltimeterHeightM);
    row.sd_z_m = csv.number_or_nan(kSdZM);
    rows.push_back(std::move(row));
  }
  return rows;
}

RunFolder read_run_folder(const std::filesystem::path& directory, std::size_t max_map_points) {
  RunFolder run;
  const std::filesystem::path trajectory_file = directory / files::kTrajectoryFile;
  run.trajectory = parse_tum(files::read_text_file(trajectory_file), trajectory_file.string());
  const std::filesystem::path status_file = directory / files::kStatusFile;
  if (std::filesystem::exists(status_file)) {
    run.status = parse_status_csv(files::read_text_file(status_file), status_file.string());
  }
  const std::filesystem::path map_file = directory / files::kMapPointsFile;
  if (std::filesystem::exists(map_file)) run.map = files::read_ply_points(map_file, max_map_points);
  return run;
}

}  // namespace isobar::evaluation
