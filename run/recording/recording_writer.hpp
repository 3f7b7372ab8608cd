// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/samples.hpp"
#include "run/recording/manifest.hpp"
#include "run/text/segments.hpp"

namespace isobar::recording {

/// Writes a recording folder (recording-format.md, version 1). Samples of one stream are written in the order
/// they are added; streams may interleave in any order. Numbers are printed so that reading gives the same
/// bits.
class RecordingWriter {
 public:
  /// Makes the folder (parents too) and the manifest, opens the files of all sensors in the manifest. Throws
  /// DataError when a file cannot be written or the folder already holds a recording.
  RecordingWriter(const std::filesystem::path& folder, const Manifest& manifest);
  ~RecordingWriter();  ///< closes; errors are lost here, so call close()
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// A UDP payload from the lidar (at most 65507 bytes), as Ethernet/IPv4/UDP in a nanosecond pcap.
  void add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload);
  /// The same, to another destination port: a Velodyne's position packets go to 8308.
  void add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload, std::uint16_t port);
  void add_imu(const ImuSample& sample);
  void add_pressure(const PressureSample& sample);
  void add_base_pressure(const PressureSample& sample);  ///< stamp on the base station's own clock
  void add_wheel(const WheelSample& sample);
  void add_reference(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);
  void add_segment(const text::Segment& segment);

  /// Flushes and closes all files. Throws DataError when anything could not be written (disk full). A sample
  /// for a sensor that is not in the manifest throws std::logic_error: that is a fault of the caller.
  void close();

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace isobar::recording
