// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>

#include "drivers/vn100/binary_packet.hpp"
#include "drivers/vn100/text_line.hpp"

namespace isobar::test::test_text_line {

using namespace vn100;

namespace {

LineSize measure(const std::string& text) {
  return measure_line(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace

TEST_CASE("the manual's examples have the checksums that it prints") {
  // UM001 v2.22, sections 5.1 and 7.2, and the VN-200's manual, section 5.11.
  CHECK(command_line("VNRRG,5") == "$VNRRG,5*46\r\n");
  CHECK(command_line("VNWRG,5,9600") == "$VNWRG,5,9600*60\r\n");
  for (const char* line : {"$VNRRG,5,9600*65\r", "$VNERR,03*72\r", "$VNRRG,8,+006.271,+000.031,-002.000*66\r",
                           "$VNRRG,9,-0.017386,-0.000303,+0.055490,+0.998308*4F\r",
                           // NMEA 0183, of the recording vn100-serial.
                           "$GPRMC,000012.800,V,,,,,0.00,0.00,060180,,,N*49\r",
                           // 16-bit checksums of VectorNav's software development kit.
                           "$VNRRG,06,1,1*0865\r", "$VNRRG,75,3,400,01,0321*3B31\r"}) {
    INFO(line);
    CHECK(measure(line).form == LineForm::kWhole);
    CHECK(measure(line).bytes == std::string(line).size() - 1);
    std::string damaged = line;
    damaged[4] ^= 1;
    CHECK(measure(damaged).form == LineForm::kNone);
  }
}

TEST_CASE("a line is incomplete at every cut, and no line once a byte is none of text") {
  const std::string line = "$VNRRG,5,9600*65\r";
  for (std::size_t length = 1; length < line.size(); ++length) {
    CHECK(measure(line.substr(0, length)).form == LineForm::kIncomplete);
  }
  CHECK(measure("$VNRRG\xfa").form == LineForm::kNone);
  CHECK(measure("$VN$VNRRG").form == LineForm::kNone);
  CHECK(measure("$" + std::string(600, 'a')).form == LineForm::kNone);
}

TEST_CASE("answers are read with either spelling of their numbers") {
  const auto answer = parse_answer("$VNWRG,75,1,4,5,201,30*00");
  REQUIRE(answer);
  CHECK(answer->kind == "WRG");
  CHECK(answer->number == 75);
  CHECK(begins_with_numbers(answer->values, "1,4,05,0201,0030"));
  CHECK_FALSE(begins_with_numbers(answer->values, "1,8,05,0201,0030"));
  CHECK_FALSE(begins_with_numbers("1,4", "1,4,05"));
  CHECK(begins_with_numbers("0,1", "0"));
  CHECK_FALSE(parse_answer("$GPRMC,75*00"));
  CHECK_FALSE(parse_answer("$VNWRG,a*00"));
  CHECK_FALSE(parse_answer("$VN*00"));
}

TEST_CASE("errors of the sensor are hexadecimal and have words") {
  const auto answer = parse_answer("$VNERR,0C*00");
  REQUIRE(answer);
  CHECK(answer->number == 12);
  CHECK(error_words(12) == std::string("baud rate too low for this output"));
  CHECK(is_refusal(12));
  CHECK_FALSE(is_refusal(2));
  CHECK(error_words(13) == nullptr);
  CHECK(error_words(-1) == nullptr);
}

}  // namespace isobar::test::test_text_line
