// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/xsens/stream_parser.hpp"

namespace isobar::xsens {

void StreamParser::filled(std::size_t count) noexcept {
  window_.filled(count);
  if (count > 0) given_up_ = false;
}

void StreamParser::restart() noexcept {
  window_.clear();
  given_up_ = false;
}

void StreamParser::skip(std::size_t count) noexcept {
  window_.drop(count);
  counters_.skipped += count;
}

Frame StreamParser::next() noexcept {
  while (!window_.bytes().empty()) {
    const std::span<const std::uint8_t> bytes = window_.bytes();
    const MessageSize size = measure_message(bytes);
    if (size.form == MessageForm::kWhole) {
      ++counters_.messages;
      window_.drop(size.bytes());
      return {true, static_cast<Id>(bytes[2]), bytes.first(size.bytes()),
              bytes.subspan(size.header_bytes, size.data_bytes), bytes.size()};
    }
    if (size.form == MessageForm::kCorrupt) ++counters_.corrupt;
    if (size.form == MessageForm::kIncomplete && !given_up_) {
      const std::size_t behind = data_behind();
      if (behind == 0) return {};
      skip(behind);
    } else {
      skip(1);
    }
  }
  return {};
}

// A false preamble may claim a length of two kilobytes, for which messages would wait. A sound MTData2 behind it
// proves it false: preamble, address and id within another message happen by chance once in 2^24 bytes.
std::size_t StreamParser::data_behind() const noexcept {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  for (std::size_t at = 1; at + 3 < bytes.size(); ++at) {
    if (bytes[at] != kPreamble || bytes[at + 1] != kMaster || static_cast<Id>(bytes[at + 2]) != Id::kData)
      continue;
    if (measure_message(bytes.subspan(at)).form == MessageForm::kWhole) return at;
  }
  return 0;
}

}  // namespace isobar::xsens
