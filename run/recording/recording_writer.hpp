// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/samples.hpp"
#include "run/recording/cloud_file.hpp"
#include "run/recording/manifest.hpp"
#include "run/recording/udp_frame.hpp"
#include "run/text/segments.hpp"

namespace isobar::recording {

struct WriterOptions {
  /// Columns that a live recording may need later: attitude also while the IMU computes none yet, variance and
  /// station of pressures, variances of the wheels.
  bool every_column = false;
};

/// Writer of a recording folder (docs/files-and-formats.md, version 1).
/// Keeps the order of each stream; streams may
/// interleave in any order. Numbers are lossless: reading gives the same bits. add_…() throws
/// std::logic_error when the manifest lacks the sensor: a fault of the caller.
class RecordingWriter {
 public:
  /// Creates the folder with its parents, writes the manifest, and opens the files of its sensors.
  /// @throws DataError when a file cannot be written or the folder already holds a recording
  RecordingWriter(const std::filesystem::path& folder, const Manifest& manifest,
                  const WriterOptions& options = {});
  ~RecordingWriter();  ///< closes without reporting errors: call close() first
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// UDP payload from the lidar (at most 65507 bytes), as Ethernet/IPv4/UDP in a nanosecond pcap; in IP fragments
  /// where it does not fit into a frame of Ethernet, as a capture of the link shows it.
  void add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload);
  /// As above, to another destination port: a Velodyne's position packets go to 8308.
  /// @param sender_ipv4 host byte order
  void add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload, std::uint16_t port,
                  std::uint32_t sender_ipv4 = kVelodyneIpv4);
  /// A cloud, where the manifest's lidar holds clouds.
  /// @return false for a cloud beyond the limits of the format: it is left out
  bool add_cloud(const CloudRecord& cloud);
  void add_imu(const ImuSample& sample);
  void add_pressure(const PressureSample& sample);
  void add_base_pressure(const PressureSample& sample);  ///< stamp on the base station's own clock
  void add_wheel(const WheelSample& sample);
  void add_reference(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base);
  void add_segment(const text::Segment& segment);

  /// Hands all whole rows and packets to the kernel: a killed process loses only what was added later.
  /// @throws DataError when any write failed (disk full)
  void flush();
  /// Flushes and closes all files.
  /// @throws DataError when any write failed (disk full)
  void close();

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace isobar::recording
