// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <vector>

#include "drivers/iio/scan_layout.hpp"

namespace isobar::test::test_scan_layout {

using namespace iio;

namespace {

std::int64_t value_of(const char* type, const std::vector<std::uint8_t>& bytes) {
  const auto parsed = parse_element_type(type);
  REQUIRE(parsed);
  REQUIRE(parsed->storage_bytes == static_cast<int>(bytes.size()));
  return parsed->value(bytes);
}

}  // namespace

TEST_CASE("values of every byte order, sign, width and shift are read") {
  CHECK(value_of("le:s16/16>>0", {0xFE, 0xFF}) == -2);
  CHECK(value_of("be:s16/16>>0", {0xFF, 0xFE}) == -2);
  CHECK(value_of("le:u16/16>>0", {0xFE, 0xFF}) == 65'534);
  CHECK(value_of("le:s12/16>>4", {0x1F, 0x80}) == -2047);  // the lowest four bits are not the value's
  CHECK(value_of("be:u12/16>>4", {0x80, 0x1F}) == 2049);
  CHECK(value_of("le:s20/32>>4", {0xF0, 0xFF, 0xFF, 0x00}) == -1);
  CHECK(value_of("be:s32/32>>0", {0x80, 0, 0, 0}) == -2'147'483'648LL);
  CHECK(value_of("le:s8/8>>0", {0x80}) == -128);
  CHECK(value_of("le:s64/64>>0", {0, 0, 0, 0, 0, 0, 0, 0x80}) == INT64_MIN);
  CHECK(value_of("le:u1/8>>7", {0x80}) == 1);
}

TEST_CASE("a malformed type is none") {
  for (const char* type :
       {"", "le", "le:", "le:s", "xe:s16/16>>0", "le:f32/32>>0", "le:s16/16", "le:s16/24>>0", "le:s16/16>>1",
        "le:s0/16>>0", "le:s16/16>>-1", "le:s16/16>>0X2", "le:s17/16>>0"}) {
    INFO(type);
    CHECK_FALSE(parse_element_type(type));
  }
}

TEST_CASE("elements stand in the order of their index, at multiples of their size") {
  ScanLayout layout;
  const auto s16 = *parse_element_type("le:s16/16>>0");
  const auto s32 = *parse_element_type("le:s32/32>>0");
  const auto s64 = *parse_element_type("le:s64/64>>0");
  // Accelerometer first, as the kernel's BMI160 has them not: the order of the index counts.
  for (std::size_t i = 0; i < 3; ++i) {
    layout.add(3 + i, static_cast<int>(i), s16);
    layout.add(i, static_cast<int>(5 + i), s32);
  }
  layout.add(kTimestampChannel, 9, s64);
  REQUIRE(layout.finish());
  // 3 x 2 bytes, 2 of padding, 3 x 4 bytes, 4 of padding, 8 bytes.
  REQUIRE(layout.scan_bytes() == 32);
  std::vector<std::uint8_t> scan(32, 0);
  scan[2] = 7;   // accel_y
  scan[12] = 9;  // anglvel_y
  scan[24] = 5;  // time
  CHECK(layout.value(scan, 4) == 7);
  CHECK(layout.value(scan, 1) == 9);
  CHECK(layout.value(scan, kTimestampChannel) == 5);
  CHECK(layout.value(scan, 0) == 0);
  layout.add(0, 0, s16);
  CHECK_FALSE(layout.finish());
}

}  // namespace isobar::test::test_scan_layout
