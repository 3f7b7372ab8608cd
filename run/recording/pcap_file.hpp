// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

struct pcap;
struct pcap_dumper;

namespace isobar::recording {

/// Writer of a pcap file with nanosecond stamps. Hands whole records to the kernel: what a killed process
/// leaves ends where a write() ended.
class PcapFile {
 public:
  /// Creates or truncates the file.
  /// @throws DataError when it cannot be written
  explicit PcapFile(const std::filesystem::path& file);
  ~PcapFile();
  PcapFile(const PcapFile&) = delete;
  PcapFile& operator=(const PcapFile&) = delete;

  /// Adds a record. A failure is kept for flush() and close().
  void write(std::int64_t stamp_ns, std::span<const std::uint8_t> frame);
  /// Hands everything written so far to the kernel.
  /// @throws DataError when any write failed
  void flush();
  /// Flushes and closes.
  /// @throws DataError when any write failed
  void close();

 private:
  void flush_buffer();
  void report() const;
  void release();

  std::string name_;
  std::vector<char> buffer_;  // of the file, must outlive it
  std::size_t pending_ = 0;   // at most so many bytes in the buffer
  int error_ = 0;             // errno of the first failed write
  pcap* handle_ = nullptr;
  pcap_dumper* dumper_ = nullptr;
};

}  // namespace isobar::recording
