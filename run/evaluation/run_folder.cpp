// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/run_folder.hpp"

#include <utility>

#include "core/errors.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::evaluation {

namespace {

enum Column : std::size_t { kStampNs, kMode, kScanMs, kAltimeterHeightM, kSdZM };

StatusRow status_row(const text::CsvReader& csv) {
  StatusRow row;
  row.stamp_ns = csv.int64(kStampNs);
  row.mode = csv.field(kMode);
  row.scan_ms = csv.number_or_nan(kScanMs);
  row.altimeter_height_m = csv.number_or_nan(kAltimeterHeightM);
  row.sd_z_m = csv.number_or_nan(kSdZM);
  return row;
}

}  // namespace

std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name) {
  text::CsvReader csv(text::TextLines(text, name), {"t_ns"},
                      {"mode", "scan_ms", "altimeter_height_m", "sd_z_m"});
  std::vector<StatusRow> rows;
  for (auto next = csv.next(); next != text::CsvReader::Row::kEnd; next = csv.next()) {
    if (next == text::CsvReader::Row::kBad) {
      if (csv.lines().without_end()) break;
      throw DataError(csv.bad_row_message());
    }
    try {
      rows.push_back(status_row(csv));
    } catch (const DataError&) {
      if (!csv.lines().without_end()) throw;
    }
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
  if (!std::filesystem::exists(map_file)) return run;
  try {
    run.map = files::read_ply_points(map_file, max_map_points);
  } catch (const DataError& error) {
    run.notes.push_back(std::string(error.what()) + "; the map is left out.");
  }
  return run;
}

}  // namespace isobar::evaluation
