// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/run_folder.hpp"

#include <utility>

#include "core/errors.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/pose_writer.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/text/csv_reader.hpp"

namespace isobar::evaluation {

namespace {

// Columns of status.csv that are read: t_ns, then these.
const std::vector<std::string_view> kOptionalColumns{"mode",
                                                     "scan_ms",
                                                     "altimeter_height_m",
                                                     "sd_z_m",
                                                     "altimeter_bias_m",
                                                     "altimeter_bias_sd_m",
                                                     "altimeter_innovation_m",
                                                     "altimeter_faulty",
                                                     "altimeter_drifts",
                                                     "airflow_s2_m",
                                                     "airflow_sd_s2_m"};
enum Column : std::size_t {
  kStampNs,
  kMode,
  kScanMs,
  kAltimeterHeightM,
  kSdZM,
  kBiasM,
  kBiasSdM,
  kInnovationM,
  kFaulty,
  kDrifts,
  kAirflow,
  kAirflowSd
};

StatusRow status_row(const text::CsvReader& csv) {
  StatusRow row;
  row.stamp_ns = csv.int64(kStampNs);
  row.mode = csv.field(kMode);
  row.scan_ms = csv.number_or_nan(kScanMs);
  row.altimeter_height_m = csv.number_or_nan(kAltimeterHeightM);
  row.sd_z_m = csv.number_or_nan(kSdZM);
  row.altimeter_bias_m = csv.number_or_nan(kBiasM);
  row.altimeter_bias_sd_m = csv.number_or_nan(kBiasSdM);
  row.altimeter_innovation_m = csv.number_or_nan(kInnovationM);
  row.altimeter_faulty = csv.field(kFaulty) == "1";
  row.altimeter_drifts = csv.field(kDrifts);
  row.airflow_s2_m = csv.number_or_nan(kAirflow);
  row.airflow_sd_s2_m = csv.number_or_nan(kAirflowSd);
  return row;
}

/// A row of covariance.csv; its columns are in the order of the header.
PoseCovariance covariance_row(const text::CsvReader& csv) {
  PoseCovariance row;
  row.stamp_ns = csv.int64(0);
  std::size_t column = 1;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      row.covariance(i, j) = row.covariance(j, i) = csv.number_or_nan(column++);
    }
  }
  return row;
}

/// All rows of a file; a last row that is cut is left out.
template <typename Row>
std::vector<Row> rows_of(text::CsvReader& csv, Row (*row_of)(const text::CsvReader& csv)) {
  std::vector<Row> rows;
  for (auto next = csv.next(); next != text::CsvReader::Row::kEnd; next = csv.next()) {
    if (next == text::CsvReader::Row::kBad) {
      if (csv.lines().without_end()) break;
      throw DataError(csv.bad_row_message());
    }
    try {
      rows.push_back(row_of(csv));
    } catch (const DataError&) {
      if (!csv.lines().without_end()) throw;
    }
  }
  return rows;
}

}  // namespace

std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name) {
  text::CsvReader csv(text::TextLines(text, name), {"t_ns"}, kOptionalColumns);
  return rows_of(csv, status_row);
}

std::vector<PoseCovariance> parse_covariance_csv(std::string_view text, const std::string& name) {
  std::vector<std::string_view> columns;
  text::split_fields(files::kCovarianceColumns, ',', columns);
  text::CsvReader csv(text::TextLines(text, name), columns);
  return rows_of(csv, covariance_row);
}

RunFolder read_run_folder(const std::filesystem::path& directory, std::size_t max_map_points) {
  RunFolder run;
  const std::filesystem::path trajectory_file = directory / files::kTrajectoryFile;
  run.trajectory = parse_tum(files::read_text_file(trajectory_file), trajectory_file.string());
  const std::filesystem::path status_file = directory / files::kStatusFile;
  if (std::filesystem::exists(status_file)) {
    run.status = parse_status_csv(files::read_text_file(status_file), status_file.string());
  }
  const std::filesystem::path covariance_file = directory / files::kCovarianceFile;
  if (std::filesystem::exists(covariance_file)) {
    run.covariances = parse_covariance_csv(files::read_text_file(covariance_file), covariance_file.string());
  }
  const std::filesystem::path mounts_file = directory / files::kMountsFile;
  if (std::filesystem::exists(mounts_file)) run.mounts = files::read_text_file(mounts_file);
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
