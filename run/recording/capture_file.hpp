// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace isobar::recording {

/// A captured frame.
struct CaptureFrame {
  std::int64_t stamp_ns = 0;            ///< time of the capture; kNoCaptureStamp where the format has none
  int data_link = 0;                    ///< libpcap's DLT_ number of the interface
  std::span<const std::uint8_t> bytes;  ///< valid until the next call of next()
};

/// An impossible stamp.
inline constexpr std::int64_t kNoCaptureStamp = -1;

/// Reader of a capture of any format, frame by frame, in bounded memory.
class CaptureFile {
 public:
  CaptureFile() = default;
  virtual ~CaptureFile() = default;
  CaptureFile(const CaptureFile&) = delete;
  CaptureFile& operator=(const CaptureFile&) = delete;

  /// The next frame; false at the end and where the file is damaged, see damage().
  virtual bool next(CaptureFrame& frame) = 0;
  /// Link type of all frames; -1: each has its own.
  [[nodiscard]] virtual int data_link() const = 0;
  /// Why reading ended before the file did; empty: it did not.
  [[nodiscard]] virtual std::string damage() const = 0;
  /// Bytes of the file as it lies on the disk that have been read.
  [[nodiscard]] virtual std::uint64_t bytes_read() const = 0;
};

/// Opens a pcap or pcapng file, compressed with gzip or not.
/// @throws DataError when the file is missing, a folder, or no capture
std::unique_ptr<CaptureFile> open_capture(const std::filesystem::path& file);

/// "Ethernet", …; "147" for a number that libpcap has no name for.
std::string data_link_name(int data_link);

}  // namespace isobar::recording
