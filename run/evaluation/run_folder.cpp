// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/run_folder.hpp"

#include <utility>

#include "run/evaluation/text_table.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"

namespace isobar::evaluation {

std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name) {
  CsvReader csv(text, name);
  const std::size_t stamp = csv.required_column("t_ns");
  const auto mode = csv.column("mode");
  const auto scan_ms = csv.column("scan_ms");
  const auto altimeter_height = csv.column("altimeter_height_m");
  const auto sd_z = csv.column("sd_z_m");
  std::vector<StatusRow> rows;
  while (csv.next_row()) {
    StatusRow row;
    row.stamp_ns = csv.int64(stamp);
    if (mode) row.mode = csv.cell(*mode);
    row.scan_ms = csv.number_or_nan(scan_ms);
    row.altimeter_height_m = csv.number_or_nan(altimeter_height);
    row.sd_z_m = csv.number_or_nan(sd_z);
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
