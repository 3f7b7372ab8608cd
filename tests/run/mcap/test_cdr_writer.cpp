// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "run/mcap/cdr_writer.hpp"
#include "run/mcap/ros_messages.hpp"

namespace isobar::test::test_cdr_writer {

using namespace isobar::mcap;
using Bytes = std::vector<std::uint8_t>;

TEST_CASE("numbers stand at multiples of their size behind the header, texts end with a counted zero") {
  CdrWriter out;
  out.put(std::uint8_t{7}).put(std::uint32_t{0x01020304}).text("ab").put(std::uint16_t{0x0506});
  CHECK(out.bytes() == Bytes{0, 1, 0, 0,                          // CDR, little endian
                             7, 0, 0, 0, 4,   3,   2, 1,          // padded to four
                             3, 0, 0, 0, 'a', 'b', 0, 0, 6, 5});  // padded to two
  // The alignment counts from behind the header: a double as first member needs no padding.
  CHECK(CdrWriter().put(1.0).bytes().size() == 12);
}

TEST_CASE("a negative stamp has its seconds rounded down and nanoseconds of at least 0") {
  const Cdr message = pressure_message({.stamp_ns = -1}, "");
  CHECK(Bytes(message.begin() + 4, message.begin() + 12) ==
        Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xC9, 0x9A, 0x3B});
}

}  // namespace isobar::test::test_cdr_writer
