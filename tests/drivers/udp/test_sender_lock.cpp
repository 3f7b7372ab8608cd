// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>

#include "drivers/udp/sender_lock.hpp"

namespace isobar::test::test_sender_lock {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr SenderAddress kFirst{0xC0A801C9, 2368};   // 192.168.1.201
constexpr SenderAddress kSecond{0xC0A801CA, 2368};  // 192.168.1.202

}  // namespace

TEST_CASE("Of two senders the first heard is used; the other takes over after 5 s of silence, not earlier") {
  SenderLock lock;
  std::int64_t now_ns = 1'000 * kMs;
  for (int i = 0; i < 100; ++i) {
    now_ns += 10 * kMs;
    CHECK(lock.admits(kFirst, now_ns));
    CHECK_FALSE(lock.admits(kSecond, now_ns));
  }
  CHECK(lock.status().refused == 100);
  CHECK(lock.status().other == kSecond);
  const std::int64_t silent_ns = now_ns;
  while (!lock.admits(kSecond, now_ns)) now_ns += 10 * kMs;
  CHECK(now_ns - silent_ns > SenderLock::kTakeoverNs);
  CHECK(now_ns - silent_ns < SenderLock::kTakeoverNs + 20 * kMs);
  CHECK(lock.status().takeovers == 1);
  CHECK(lock.status().takeover_ns == now_ns);
  CHECK_FALSE(lock.admits(kFirst, now_ns + kMs));
}

TEST_CASE("Only the configured senders are admitted, also when they come later") {
  SenderLock lock({kSecond.ipv4});
  CHECK_FALSE(lock.admits(kFirst, 1));
  CHECK(lock.admits(kSecond, 2));
  CHECK_FALSE(lock.admits(kFirst, 3));
  CHECK_FALSE(lock.admits(kFirst, 3 + 10 * SenderLock::kTakeoverNs));
  CHECK(lock.status().in_use == kSecond);
  CHECK(lock.status().refused == 3);
}

TEST_CASE("A program that opens a socket for each datagram, or restarts, is one sender") {
  SenderLock lock;
  SenderAddress sender = kFirst;
  for (int i = 0; i < 50; ++i) {
    ++sender.port;
    CHECK(lock.admits(sender, i * 20 * kMs));
  }
  CHECK(lock.status().refused == 0);
}

TEST_CASE("Two programs of one address are two senders: the first alone is used, and no sample is mixed") {
  SenderLock lock;
  SenderAddress other = kFirst;
  CHECK(lock.admits(kFirst, -5 * kMs));
  for (int i = 0; i < 200; ++i) {
    CHECK(lock.admits(kFirst, i * 5 * kMs));
    ++other.port;  // even with another port each time
    CHECK_FALSE(lock.admits(other, i * 5 * kMs + kMs));
  }
  CHECK(lock.status().in_use == kFirst);
  CHECK(lock.status().refused == 200);
}

TEST_CASE(
    "Two programs of one address that begin at the same time: one sample is mixed, then only the first is "
    "used") {
  SenderLock lock;
  SenderAddress other = kFirst;
  ++other.port;
  int mixed = 0;
  for (int i = 0; i < 200; ++i) {
    CHECK(lock.admits(kFirst, i * 5 * kMs));
    mixed += lock.admits(other, i * 5 * kMs + kMs) ? 1 : 0;
  }
  CHECK(mixed == 1);
  CHECK(lock.status().in_use == kFirst);
}

TEST_CASE("A program that restarts with another port is used again after three of its intervals") {
  for (const std::int64_t interval_ns : {5 * kMs, 33 * kMs, 1000 * kMs}) {
    SenderLock lock;
    std::int64_t now_ns = 0;
    for (int i = 0; i < 50; ++i) CHECK(lock.admits(kFirst, now_ns += interval_ns));
    SenderAddress restarted = kFirst;
    restarted.port += 3;
    const std::int64_t silent_ns = now_ns;
    while (!lock.admits(restarted, now_ns)) now_ns += kMs;
    CHECK(now_ns - silent_ns ==
          std::clamp(3 * interval_ns, SenderLock::kLeastPortWaitNs, SenderLock::kMostPortWaitNs));
    CHECK(lock.status().takeovers == 0);
  }
}

}  // namespace isobar::test::test_sender_lock
