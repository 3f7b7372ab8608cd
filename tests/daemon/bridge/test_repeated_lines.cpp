// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/repeated_lines.hpp"

#include <doctest/doctest.h>

#include <string>

namespace isobar::test::test_repeated_lines {

using bridge::RepeatedLines;

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

TEST_CASE("of lines that differ in numbers only the first is logged, then a count a minute") {
  RepeatedLines lines;
  const auto line = [](int port) { return "write to udp/10.0.0.5:" + std::to_string(port) + " failed"; };
  CHECK(lines.note(line(7410), 0).value_or("") == line(7410));
  int logged = 0;
  for (int i = 0; i < 800; ++i) {
    logged += lines.note(line(i), i * kSecondNs / 100).has_value() ? 1 : 0;
    logged += static_cast<int>(lines.due(i * kSecondNs / 100).size());
  }
  CHECK(logged == 0);
  CHECK(lines.due(59 * kSecondNs).empty());
  const auto counts = lines.due(60 * kSecondNs);
  REQUIRE(counts.size() == 1);
  CHECK(counts[0] == "800 more in 60 s: " + line(7410));
  CHECK(lines.due(61 * kSecondNs).empty());
}

TEST_CASE("a kind that was silent for a minute is logged at once again") {
  RepeatedLines lines;
  lines.note("lost", 0);
  CHECK_FALSE(lines.note("lost", kSecondNs).has_value());
  CHECK(lines.due(60 * kSecondNs).size() == 1);
  CHECK(lines.due(120 * kSecondNs).empty());
  CHECK(lines.note("lost", 121 * kSecondNs).has_value());
}

TEST_CASE("a stranger's bytes neither fill the log nor reach the terminal") {
  RepeatedLines lines;
  CHECK(lines.note("type \x1b[2J\n\xff", 0).value_or("") == "type ?[2J??");
  CHECK(lines.note(std::string(100'000, 'z'), 0).value_or("").size() == RepeatedLines::kMaxLineBytes);
  int logged = 0;
  for (int i = 0; i < 10'000; ++i) {
    std::string garbage = "kind ";
    for (int bits = i; bits > 0; bits /= 2) garbage += bits % 2 == 0 ? 'x' : 'y';
    logged += lines.note(garbage, i).has_value() ? 1 : 0;
  }
  CHECK(logged <= static_cast<int>(RepeatedLines::kMaxKinds));
}

}  // namespace

}  // namespace isobar::test::test_repeated_lines
