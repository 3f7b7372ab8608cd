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
    logged += lines.due(i * kSecondNs / 100).has_value() ? 1 : 0;
  }
  CHECK(logged == 0);
  CHECK_FALSE(lines.due(59 * kSecondNs).has_value());
  CHECK(lines.due(60 * kSecondNs).value_or("") == "800 more in 60 s: " + line(7410));
  CHECK_FALSE(lines.due(61 * kSecondNs).has_value());
}

TEST_CASE(
    "the count of a kind that returns after five quiet minutes is logged within a minute, its line after an "
    "hour") {
  RepeatedLines lines;
  lines.note("lost", 0);
  CHECK_FALSE(lines.note("lost", kSecondNs).has_value());
  CHECK(lines.due(61 * kSecondNs).has_value());
  CHECK_FALSE(lines.note("lost", 400 * kSecondNs).has_value());
  CHECK(lines.due(460 * kSecondNs).value_or("") == "1 more in 60 s: lost");
  CHECK_FALSE(lines.due(4060 * kSecondNs).has_value());
  CHECK(lines.note("lost", 4061 * kSecondNs).has_value());
}

TEST_CASE("an attack of any duration with many kinds of lines writes fewer than 30 lines in its first hour") {
  RepeatedLines lines;
  int logged = 0;
  std::string last;
  for (int second = 0; second < 3600; ++second) {
    for (int kind = 0; kind < 40; ++kind) {
      logged +=
          lines.note("state " + std::string(static_cast<std::size_t>(kind), 'x'), second * kSecondNs) ? 1 : 0;
    }
    if (const auto line = lines.due(second * kSecondNs)) {
      ++logged;
      last = *line;
    }
  }
  CHECK(logged < 30);
  CHECK(last.find(" of 17 kinds, ") != std::string::npos);
  CHECK(last.find("lines of further kinds") != std::string::npos);
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
