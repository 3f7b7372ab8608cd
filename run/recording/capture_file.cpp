// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/capture_file.hpp"

#include <pcap/pcap.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/pcapng_file.hpp"
#include "run/text/gzip_file.hpp"

namespace isobar::recording {
namespace {

// Size of the file buffer: 200 packets per read() instead of three.
constexpr std::size_t kCaptureBufferBytes = std::size_t{256} * 1024;

ssize_t read_cookie(void* cookie, char* to, std::size_t size) {
  return static_cast<ssize_t>(static_cast<text::GzipFile*>(cookie)->read(to, size));
}

/// A pcap file, read by libpcap: both byte orders, micro- and nanoseconds, and the variants that it knows.
class PcapFormatFile : public CaptureFile {
 public:
  PcapFormatFile(std::unique_ptr<text::GzipFile> file, const std::string& name)
      : file_(std::move(file)), buffer_(kCaptureBufferBytes) {
    cookie_io_functions_t functions{};
    functions.read = read_cookie;
    std::FILE* stream = fopencookie(file_.get(), "rb", functions);
    if (stream == nullptr) {
      throw DataError(name + ": cannot be read: " + std::strerror(errno));
    }
    std::setvbuf(stream, buffer_.data(), _IOFBF, buffer_.size());
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    handle_ = pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data());
    if (handle_ == nullptr) {
      std::fclose(stream);
      throw DataError(name + ": is no pcap file: " + error.data() +
                      (file_->damage().empty() ? "" : "; " + file_->damage()));
    }
  }
  ~PcapFormatFile() override { pcap_close(handle_); }
  PcapFormatFile(const PcapFormatFile&) = delete;
  PcapFormatFile& operator=(const PcapFormatFile&) = delete;

  bool next(CaptureFrame& frame) override {
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    const int status = pcap_next_ex(handle_, &header, &data);
    if (status != 1) {
      if (status == PCAP_ERROR) damage_ = pcap_geterr(handle_);
      if (!file_->damage().empty()) damage_ = file_->damage();
      return false;
    }
    frame.stamp_ns = static_cast<std::int64_t>(header->ts.tv_sec) * 1'000'000'000 + header->ts.tv_usec;
    frame.data_link = pcap_datalink(handle_);
    frame.bytes = {data, header->caplen};
    return true;
  }
  [[nodiscard]] int data_link() const override { return pcap_datalink(handle_); }
  [[nodiscard]] std::string damage() const override { return damage_; }
  [[nodiscard]] std::uint64_t bytes_read() const override { return file_->bytes_read(); }

 private:
  std::unique_ptr<text::GzipFile> file_;
  std::vector<char> buffer_;  // file buffer of handle_
  pcap* handle_ = nullptr;
  std::string damage_;
};

}  // namespace

std::unique_ptr<CaptureFile> open_capture(const std::filesystem::path& file) {
  const std::string name = file.string();
  auto bytes = std::make_unique<text::GzipFile>(file);
  if (is_pcapng(bytes->head())) return std::make_unique<PcapngFile>(std::move(bytes));
  return std::make_unique<PcapFormatFile>(std::move(bytes), name);
}

std::string data_link_name(int data_link) {
  const char* name = pcap_datalink_val_to_name(data_link);
  return name == nullptr ? std::to_string(data_link) : name;
}

}  // namespace isobar::recording
