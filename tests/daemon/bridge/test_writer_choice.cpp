// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/writer_choice.hpp"

#include <doctest/doctest.h>

namespace isobar::test::test_writer_choice {

using bridge::WriterChoice;

namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST_CASE("of two writers of a topic the first heard is used, until it has been silent for 5 s") {
  WriterChoice choice;
  const auto present = [](std::uint64_t) { return true; };
  std::int64_t now_ns = 1000 * kMs;
  for (int i = 0; i < 100; ++i) {
    now_ns += 5 * kMs;
    CHECK(choice.admits(7, now_ns, present));
    CHECK_FALSE(choice.admits(8, now_ns, present));
  }
  CHECK(choice.refused() == 100);
  CHECK_FALSE(choice.admits(8, now_ns + WriterChoice::kTakeoverNs, present));
  CHECK(choice.admits(8, now_ns + WriterChoice::kTakeoverNs + 1, present));
  CHECK_FALSE(choice.admits(7, now_ns + WriterChoice::kTakeoverNs + 2, present));
}

TEST_CASE("a node that was restarted is used at once: its former writer is gone") {
  WriterChoice choice;
  bool is_there = true;
  const auto present = [&](std::uint64_t writer) { return writer == 8 || is_there; };
  CHECK(choice.admits(7, kMs, present));
  CHECK_FALSE(choice.admits(8, 2 * kMs, present));
  is_there = false;
  CHECK(choice.admits(8, 3 * kMs, present));
  CHECK(choice.refused() == 1);
}

}  // namespace

}  // namespace isobar::test::test_writer_choice
