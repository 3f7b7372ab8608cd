// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/recording/recording_writer.hpp"
#include "run/recording/reference.hpp"
#include "tools/import/request.hpp"
#include "tools/import/sample_log.hpp"

namespace isobar::tools {

/// Files that a person names beside the source: --imu FILE, --pressure FILE, --base-pressure FILE, --reference FILE.
class AddedLogs {
 public:
  /// Reads the options that name files.
  /// @throws DataError, UsageError as read_sample_log()
  explicit AddedLogs(const ImportRequest& request);

  /// The request for the source alone: what files bring is none of its topics.
  [[nodiscard]] ImportRequest without(ImportRequest request) const;
  /// Takes IMU and barometer from the source itself, a log.
  void use_source(const ImportRequest& request);
  void use_imu(std::vector<ImuSample> samples, const std::string& name, const std::string& type);
  /// Puts logs that count from their sensor's start on the lidar's clock, by --log-offset.
  /// @param lidar_first_ns its first packet or scan
  /// @throws UsageError naming --log-offset
  void align(std::int64_t lidar_first_ns);
  /// Names the files' sensors in a manifest, with their mounts.
  /// @throws UsageError naming --mount imu where a lidar is there
  void add_to(recording::Manifest& manifest, const ImportRequest& request) const;
  /// Writes the samples, and a row a file.
  void write(recording::RecordingWriter& writer, ImportReport& report) const;

 private:
  struct Named {
    std::string name;
    SampleLog log;
  };
  std::optional<double> offset_s_;
  std::optional<Named> imu_;
  std::optional<Named> pressure_;
  std::optional<Named> base_pressure_;
  std::vector<recording::StampedPose> reference_;
  std::string reference_name_;
};

}  // namespace isobar::tools
