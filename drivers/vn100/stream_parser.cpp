// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/stream_parser.hpp"

#include <algorithm>

#include "drivers/vn100/text_line.hpp"

namespace isobar::vn100 {

void StreamParser::filled(std::size_t count) noexcept {
  window_.filled(count);
  if (count > 0) given_up_ = false;
}

void StreamParser::restart() noexcept {
  window_.clear();
  given_up_ = false;
  header_bytes_ = 0;
  unknown_count_ = 0;
}

void StreamParser::skip(std::size_t count) noexcept {
  window_.drop(count);
  counters_.skipped += count;
}

Frame StreamParser::next() noexcept {
  while (!window_.bytes().empty()) {
    const std::span<const std::uint8_t> bytes = window_.bytes();
    bool incomplete = false;
    if (bytes[0] == kSync) {
      const PacketSize size = measure_packet(bytes);
      if (size.form == PacketForm::kWhole) return take_packet(size);
      if (size.form == PacketForm::kCorrupt && has_known_header(bytes)) ++counters_.corrupt;
      if (size.form == PacketForm::kNone) note_unknown(bytes.first(size.header_bytes));
      incomplete = size.form == PacketForm::kIncomplete;
    } else if (bytes[0] == '$') {
      const LineSize size = measure_line(bytes);
      if (size.form == LineForm::kWhole) {
        ++counters_.lines;
        window_.drop(size.bytes);
        return {Frame::Kind::kText, bytes.first(size.bytes), bytes.size()};
      }
      incomplete = size.form == LineForm::kIncomplete;
    }
    if (incomplete && !given_up_) {
      const std::size_t behind = known_packet_behind();
      if (behind == 0) return {};
      skip(behind);
    } else {
      skip(1);
    }
  }
  return {};
}

// Vote of the majority: an equal header counts for the one that is kept, another against it.
void StreamParser::note_unknown(std::span<const std::uint8_t> header) noexcept {
  constexpr int kMost = 1'000;
  if (header.size() > unknown_header_.size()) return;
  if (std::equal(header.begin(), header.end(), unknown_header().begin(), unknown_header().end())) {
    unknown_count_ = std::min(unknown_count_ + 1, kMost);
  } else if (unknown_count_ > 0) {
    --unknown_count_;
  } else {
    std::copy(header.begin(), header.end(), unknown_header_.begin());
    unknown_bytes_ = header.size();
    unknown_count_ = 1;
  }
}

Frame StreamParser::take_packet(const PacketSize& size) noexcept {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  header_bytes_ = std::min(size.header_bytes, header_.size());
  std::copy_n(bytes.begin(), header_bytes_, header_.begin());
  ++counters_.packets;
  window_.drop(size.bytes);
  return {Frame::Kind::kBinary, bytes.first(size.bytes), bytes.size()};
}

bool StreamParser::has_known_header(std::span<const std::uint8_t> bytes) const noexcept {
  return header_bytes_ > 0 && bytes.size() >= header_bytes_ &&
         std::equal(header_.begin(), header_.begin() + static_cast<std::ptrdiff_t>(header_bytes_),
                    bytes.begin());
}

// A false sync byte may claim a length of a kilobyte, for which packets would wait. A whole packet with the
// known header and a CRC that holds, which within another packet happens by chance once in 2^64 bytes, proves
// it false.
std::size_t StreamParser::known_packet_behind() const noexcept {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  for (std::size_t at = 1; header_bytes_ > 0 && at + header_bytes_ < bytes.size(); ++at) {
    if (bytes[at] != kSync || !has_known_header(bytes.subspan(at))) continue;
    if (measure_packet(bytes.subspan(at)).form == PacketForm::kWhole) return at;
  }
  return 0;
}

}  // namespace isobar::vn100
