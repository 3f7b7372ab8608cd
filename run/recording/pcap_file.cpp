// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/pcap_file.hpp"

#include <pcap/pcap.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/errors.hpp"
#include "run/recording/udp_frame.hpp"

namespace isobar::recording {
namespace {

constexpr int kSnapLength = 65'535 + static_cast<int>(kEthernetHeaderBytes);
/// Size of the file's header, and upper bound of a record's.
constexpr std::size_t kPcapHeaderBytes = 24;
constexpr std::size_t kPcapBufferBytes = std::size_t{1} << 18U;

}  // namespace

PcapFile::PcapFile(const std::filesystem::path& file)
    : name_(file.string()), buffer_(kPcapBufferBytes), pending_(kPcapHeaderBytes) {
  std::FILE* stream = std::fopen(name_.c_str(), "wb");
  if (stream == nullptr) {
    throw DataError(name_ + ": cannot be written: " + std::strerror(errno));
  }
  std::setvbuf(stream, buffer_.data(), _IOFBF, buffer_.size());
  handle_ = pcap_open_dead_with_tstamp_precision(DLT_EN10MB, kSnapLength, PCAP_TSTAMP_PRECISION_NANO);
  dumper_ = handle_ == nullptr ? nullptr : pcap_dump_fopen(handle_, stream);
  if (dumper_ == nullptr) {
    const std::string reason = handle_ == nullptr ? "libpcap refused" : pcap_geterr(handle_);
    release();
    throw DataError(name_ + ": cannot be written: " + reason);
  }
}

PcapFile::~PcapFile() { release(); }

void PcapFile::write(std::int64_t stamp_ns, std::span<const std::uint8_t> frame) {
  pcap_pkthdr header{};
  header.ts.tv_sec = stamp_ns / 1'000'000'000;
  header.ts.tv_usec = stamp_ns % 1'000'000'000;  // nanoseconds: PCAP_TSTAMP_PRECISION_NANO
  header.caplen = static_cast<bpf_u_int32>(frame.size());
  header.len = header.caplen;
  if (pending_ + kPcapHeaderBytes + frame.size() > buffer_.size()) {
    flush_buffer();
  }
  pending_ += kPcapHeaderBytes + frame.size();
  pcap_dump(reinterpret_cast<u_char*>(dumper_), &header, frame.data());
}

void PcapFile::flush() {
  if (dumper_ != nullptr) {
    flush_buffer();
  }
  report();
}

void PcapFile::close() {
  if (dumper_ == nullptr) {
    return;
  }
  flush_buffer();
  release();
  report();
}

void PcapFile::flush_buffer() {
  errno = 0;
  const bool failed = pcap_dump_flush(dumper_) != 0 || std::ferror(pcap_dump_file(dumper_)) != 0;
  if (failed && error_ == 0) {
    error_ = errno != 0 ? errno : EIO;
  }
  pending_ = 0;
}

void PcapFile::report() const {
  if (error_ != 0) {
    throw DataError(name_ + ": could not be written completely: " + std::strerror(error_));
  }
}

void PcapFile::release() {
  if (dumper_ != nullptr) {
    pcap_dump_close(dumper_);
    dumper_ = nullptr;
  }
  if (handle_ != nullptr) {
    pcap_close(handle_);
    handle_ = nullptr;
  }
}

}  // namespace isobar::recording
