// SPDX-License-Identifier: BSD-3-Clause
// lidar.clouds: point clouds of a recording whose lidar gave no packets (docs/files-and-formats.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run/recording/csv_writer.hpp"
#include "run/recording/tally.hpp"
#include "run/text/gzip_file.hpp"

namespace isobar::recording {

/// Name that stands in [lidar] model for a recording of clouds.
inline constexpr const char* kCloudModel = "clouds";
inline constexpr std::uint32_t kCloudFileVersion = 1;
/// Longest record [bytes].
inline constexpr std::uint32_t kMostCloudBytes = 256U << 20U;

/// A field of each point, as sensor_msgs/PointField says it. Nothing of it has been checked.
struct CloudRecordField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
};

/// A cloud as sensor_msgs/PointCloud2 lays it out, with the bytes of its points as they came. Nothing of it has been
/// checked but the lengths.
struct CloudRecord {
  std::int64_t stamp_ns = 0;  ///< of the message's header, on its sender's clock, as are times in the points
  std::int64_t shift_ns = 0;  ///< robot's clock minus that clock
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;  ///< [bytes]
  std::uint32_t row_step = 0;    ///< [bytes]
  bool is_bigendian = false;
  std::vector<CloudRecordField> fields;
  std::vector<std::uint8_t> data;
};

/// Writer of a file of clouds. Errors are kept for flush() and close(), as TextFile does.
class CloudFileWriter {
 public:
  /// @throws DataError when the file cannot be opened
  explicit CloudFileWriter(const std::filesystem::path& file);
  /// @return false for a cloud beyond the limits of the format: it is left out
  bool write(const CloudRecord& cloud);
  void flush() { file_.flush(); }
  void close() { file_.close(); }

 private:
  TextFile file_;
  std::string head_;  // of the record that is written
};

/// Reader of a file of clouds, compressed with gzip or not, in bounded memory.
class CloudFileReader {
 public:
  struct Tallies {
    Tally damaged;    ///< records whose check sum is wrong, or that break the format
    Tally truncated;  ///< 1 when the file ends within a record
  };

  /// @throws DataError when the file is missing, or no file of clouds of this version
  explicit CloudFileReader(const std::filesystem::path& file);
  /// The next cloud; false at the end. Reuses the memory of `cloud`.
  bool next(CloudRecord& cloud);

  [[nodiscard]] const Tallies& tallies() const { return tallies_; }
  [[nodiscard]] std::uint64_t bytes_read() const { return file_.bytes_read(); }

 private:
  [[nodiscard]] std::size_t read(std::size_t size);
  [[nodiscard]] std::string place() const;

  std::string name_;
  text::GzipFile file_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t records_ = 0;
  Tallies tallies_;
};

}  // namespace isobar::recording
