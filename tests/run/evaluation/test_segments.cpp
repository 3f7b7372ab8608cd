// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/errors.hpp"
#include "core/statistics/distribution.hpp"
#include "run/evaluation/segments.hpp"
#include "run/text/segments.hpp"

namespace isobar::test::test_segments {

using namespace isobar::evaluation;
using doctest::Approx;

namespace {

std::string message_of(const std::string& text) {
  try {
    text::read_segments(text::TextLines(text, "s.csv"));
  } catch (const isobar::DataError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("Segments are read by column name in any order, with unknown columns, blanks, CRLF and a BOM") {
  const std::vector<Segment> s = text::read_segments(text::TextLines(
      "\xEF\xBB\xBFlabel, t_end_ns ,floor,t_start_ns\r\nflat,20,3,10\r\n\r\nstairs , 30,,20\r\nflat,9,1,5",
      "s.csv"));
  REQUIRE(s.size() == 3);
  CHECK(s[0].start_ns == 10);
  CHECK(s[0].end_ns == 20);
  CHECK(s[1].label == "stairs");
  const std::vector<Segment> flat = flat_segments(s);
  REQUIRE(flat.size() == 2);
  CHECK(flat[0].start_ns == 5);
}

TEST_CASE("A broken segments file is refused with file, line, column and rule") {
  CHECK(message_of("") == "s.csv:1: is empty, must start with a line that names the columns");
  CHECK(message_of("t_start_ns,label\n") == "s.csv:1: column 't_end_ns' is missing");
  CHECK(message_of("t_start_ns,t_end_ns,label,label\n") == "s.csv:1: column 'label' is named twice");
  CHECK(message_of("t_start_ns,t_end_ns,label\n1,2\n") == "s.csv:2: has 2 fields, the header names 3");
  CHECK(message_of("t_start_ns,t_end_ns,label\n1.5,2,flat\n") ==
        "s.csv:2: t_start_ns: '1.5' is not a whole number");
  CHECK(message_of("t_start_ns,t_end_ns,label\n1,99999999999999999999,flat\n") ==
        "s.csv:2: t_end_ns: '99999999999999999999' is not a whole number");
  CHECK(message_of("t_start_ns,t_end_ns,label\n5,2,flat\n") == "s.csv:2: the segment ends before it starts");
  CHECK(message_of("t_start_ns,t_end_ns,label\n1,2,\n") == "s.csv:2: label: is empty");
}

TEST_CASE("Quantiles of 0 … 100 are the percentages themselves") {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const Distribution d = summarize(values);
  CHECK(d.count == 101);
  CHECK(d.p05 == Approx(5.0));
  CHECK(d.q25 == Approx(25.0));
  CHECK(d.median == Approx(50.0));
  CHECK(d.q75 == Approx(75.0));
  CHECK(d.p95 == Approx(95.0));
  CHECK(d.p99 == Approx(99.0));
  CHECK(d.max == 100.0);
  CHECK(median({5.0, 1.0, 2.0, 9.0}) == Approx(3.5));
  CHECK(quantile({1.0, 2.0}, 0.5) == Approx(1.5));
  CHECK(std::isnan(summarize({}).median));
}

}  // namespace isobar::test::test_segments
