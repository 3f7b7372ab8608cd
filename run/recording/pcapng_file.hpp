// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "run/recording/capture_file.hpp"
#include "run/text/gzip_file.hpp"

namespace isobar::recording {

/// True for the first bytes of a pcapng file: the type of a section header block, the same in both byte orders.
[[nodiscard]] bool is_pcapng(std::string_view head);

/// A pcapng file (draft-ietf-opsawg-pcapng): several sections, each with its byte order and its interfaces,
/// each of these with its link type and resolution of time. libpcap refuses interfaces of different link types.
/// Blocks without a frame are skipped. Every length is checked before use.
class PcapngFile : public CaptureFile {
 public:
  explicit PcapngFile(std::unique_ptr<text::GzipFile> file) : file_(std::move(file)) {}

  bool next(CaptureFrame& frame) override;
  [[nodiscard]] int data_link() const override { return -1; }
  [[nodiscard]] std::string damage() const override { return damage_; }
  [[nodiscard]] std::uint64_t bytes_read() const override { return file_->bytes_read(); }

 private:
  struct Interface {
    int data_link = 0;
    std::uint64_t units_per_s = 1'000'000;
    std::int64_t offset_s = 0;
  };

  bool read_block(std::uint32_t& type);
  bool read_exactly(std::uint8_t* to, std::size_t size, bool may_end);
  bool add_interface();
  void read_options(std::size_t at, Interface& interface) const;
  bool take_enhanced(CaptureFrame& frame);
  bool take_simple(CaptureFrame& frame);
  bool take_obsolete(CaptureFrame& frame);
  bool give(std::size_t interface, std::int64_t stamp_ns, std::size_t at, std::size_t size,
            CaptureFrame& frame);
  bool fail(const std::string& reason);
  [[nodiscard]] std::int64_t stamp_ns(std::size_t interface, std::size_t at) const;
  [[nodiscard]] std::uint32_t u16(std::size_t at) const;
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return u32_of(body_.data() + at); }
  [[nodiscard]] std::uint32_t u32_of(const std::uint8_t* at) const;

  std::unique_ptr<text::GzipFile> file_;
  bool big_endian_ = false;
  std::vector<Interface> interfaces_;  // of the section
  std::vector<std::uint8_t> body_;     // of the block
  std::string damage_;
  bool ended_ = false;
};

}  // namespace isobar::recording
