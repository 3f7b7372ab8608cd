// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "core/time/stamp_guard.hpp"

namespace isobar::test::test_stamp_guard {

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;
using V = StampVerdict;

std::vector<V> verdicts(StampGuard& guard, const std::vector<std::int64_t>& stamps_ms) {
  std::vector<V> result;
  for (const std::int64_t stamp_ms : stamps_ms) {
    result.push_back(guard.check(stamp_ms * kMs));
  }
  return result;
}

}  // namespace

TEST_CASE("One absurd stamp is held and does not make later ones look old") {
  StampGuard guard;
  CHECK(verdicts(guard, {1'000, 1'010, 9'000'000'000, 1'020, 1'030, 5, 1'040}) ==
        std::vector<V>{V::kAccept, V::kAccept, V::kHeld, V::kAccept, V::kAccept, V::kHeld, V::kAccept});
  CHECK(guard.absurd() == 2);
  CHECK(guard.newest_ns() == 1'040 * kMs);
}

TEST_CASE("A gap and a clock set back are confirmed by the second sample") {
  StampGuard guard;
  CHECK(verdicts(guard, {1'000, 1'010, 61'000, 61'010, 61'020, 1'500, 1'510, 1'520}) ==
        std::vector<V>{V::kAccept, V::kAccept, V::kHeld, V::kConfirmed, V::kAccept, V::kHeld, V::kConfirmed,
                       V::kAccept});
  CHECK(guard.gaps() == 1);
  CHECK(guard.steps_back() == 1);
  CHECK(guard.absurd() == 0);
}

TEST_CASE("Neither a different absurd stamp nor a copy confirms a held stamp") {
  StampGuard guard;
  CHECK(verdicts(guard, {1'000, 9'000'000, 5'000'000, 1'010, 9'000'000, 9'000'000, 1'020}) ==
        std::vector<V>{V::kAccept, V::kHeld, V::kHeld, V::kAccept, V::kHeld, V::kHeld, V::kAccept});
}

TEST_CASE("Repeated and overtaken stamps are distinguished and counted") {
  StampGuard guard;
  CHECK(verdicts(guard, {1'000, 1'000, 1'020, 1'010, 1'030}) ==
        std::vector<V>{V::kAccept, V::kDuplicate, V::kAccept, V::kReordered, V::kAccept});
  CHECK(guard.duplicates() == 1);
  CHECK(guard.reordered() == 1);
}

TEST_CASE("A stream slower than the limit is recognised by its even steps") {
  StampGuard guard;
  CHECK(guard.check(0) == V::kAccept);
  CHECK(guard.check(60 * kSecond) == V::kHeld);
  CHECK(guard.check(120 * kSecond) == V::kConfirmed);
  CHECK(guard.check(180 * kSecond) == V::kAccept);
}

}  // namespace isobar::test::test_stamp_guard
