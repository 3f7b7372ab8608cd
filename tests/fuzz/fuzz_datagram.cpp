// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: datagrams, separated by zero bytes. An accepted sample must survive formatting and parsing.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "drivers/datagram/datagram.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isobar::datagram;
  DatagramParser parser;
  std::span<const std::uint8_t> rest(data, size);
  while (!rest.empty()) {
    std::size_t length = 0;
    while (length < rest.size() && rest[length] != 0) {
      ++length;
    }
    parser.begin(rest.first(length));
    rest = rest.subspan(std::min(rest.size(), length + 1));
    Sample sample;
    while (parser.next(sample)) {
      std::array<char, kMaxLineBytes> first{};
      std::array<char, kMaxLineBytes> second{};
      const std::size_t written = format_line(sample, first);
      Sample again;
      if (parse_line({first.data(), written - 1}, again) != LineStatus::kOk ||
          format_line(again, second) != written || first != second) {
        std::abort();
      }
    }
  }
  return 0;
}
