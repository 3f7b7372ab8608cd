// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "drivers/xsens/data_items.hpp"
#include "drivers/xsens/message.hpp"
#include "tests/drivers/xsens/message_writer.hpp"

namespace isobar::test::test_data_items {

using namespace xsens;

TEST_CASE("every number format gives the value that was written, to its resolution") {
  const double resolutions[4] = {1e-6, 0x1p-20, 0x1p-32, 0.0};
  for (std::uint16_t precision = 0; precision < 4; ++precision) {
    for (const double value : {0.0, 1.0, -1.0, 9.80665, -9.80665, 1e-5, -1e-5, 1234.56, -1234.56}) {
      MessageWriter writer;
      writer.numbers(static_cast<std::uint16_t>(0x4020 | precision), {value, 0.5, -value});
      std::span<const std::uint8_t> data = writer.data();
      const auto item = take_item(data);
      REQUIRE(item);
      CHECK(data.empty());
      CHECK(item->is(Item::kAcceleration));
      REQUIRE(item->has_numbers(3));
      const double tolerance = resolutions[precision] * (precision == 0 ? std::abs(value) : 1.0);
      CHECK(std::abs(item->number(0) - value) <= tolerance);
      CHECK(item->number(1) == 0.5);
      CHECK(std::abs(item->number(2) + value) <= tolerance);
    }
  }
}

TEST_CASE("the world of an attitude is in bits 2 and 3, whose fourth value is reserved") {
  CHECK(DataItem{0x2010, {}}.world() == World::kEastNorthUp);
  CHECK(DataItem{0x2014, {}}.world() == World::kNorthEastDown);
  CHECK(DataItem{0x2018, {}}.world() == World::kNorthWestUp);
  CHECK_FALSE(DataItem{0x201C, {}}.world());
}

TEST_CASE("items fill a message exactly, or it is none") {
  MessageWriter writer;
  writer.integer(0x1020, 7, 2).numbers(0x4020, {1, 2, 3});
  auto data = writer.data();
  CHECK(items_fill(data));
  CHECK_FALSE(items_fill({}));
  for (std::size_t length = 1; length < data.size(); ++length) {
    if (length == 5) continue;  // the end of the first item
    CHECK_FALSE(items_fill(std::span(data).first(length)));
  }
  data.push_back(0);
  CHECK_FALSE(items_fill(data));
}

TEST_CASE("commands have the checksums of the vendor's tools") {
  // Recorded from the vendor's MT Manager (xsens-xbus/mti-300_mtmanager_packets.md).
  using Bytes = std::vector<std::uint8_t>;
  CHECK(make_message(Id::kGoToConfig, {}) == Bytes{0xFA, 0xFF, 0x30, 0x00, 0xD1});
  CHECK(make_message(Id::kGoToMeasurement, {}) == Bytes{0xFA, 0xFF, 0x10, 0x00, 0xF1});
  const Bytes outputs{0x10, 0x20, 0xFF, 0xFF, 0x10, 0x60, 0xFF, 0xFF, 0x20, 0x10, 0x01, 0x90,
                      0x40, 0x20, 0x01, 0x90, 0x40, 0x10, 0x01, 0x90, 0x40, 0x30, 0x01, 0x90,
                      0x80, 0x20, 0x01, 0x90, 0x80, 0x30, 0x01, 0x90, 0xC0, 0x20, 0x00, 0x64,
                      0x08, 0x10, 0x00, 0x0A, 0x30, 0x10, 0x00, 0x32, 0xE0, 0x20, 0xFF, 0xFF};
  CHECK(make_message(Id::kSetOutput, outputs).back() == 0x99);
}

TEST_CASE("the sensor's errors have words") {
  CHECK(error_words(33) == std::string("invalid parameter"));
  CHECK(error_words(3) == std::string("period outside the valid range"));
  CHECK(error_words(0) == nullptr);
  CHECK(error_words(255) == nullptr);
}

}  // namespace isobar::test::test_data_items
