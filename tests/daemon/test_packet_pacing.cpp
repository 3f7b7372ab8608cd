// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/packet_pacing.hpp"

#include <doctest/doctest.h>

#include <initializer_list>

namespace isobar::test::test_packet_pacing {

using isobar::PacketPacing;

namespace {

constexpr std::int64_t kMs = 1'000'000;
/// Start time, far from 0, which means "none yet".
constexpr std::int64_t kStart = 1'000'000 * kMs;

PacketPacing turning(std::int64_t period_ns) {
  PacketPacing pacing;
  pacing.scan_ended(kStart - period_ns);
  pacing.scan_ended(kStart);
  return pacing;
}

}  // namespace

TEST_CASE("before two scans have given the period every packet is fetched at once") {
  PacketPacing pacing;
  CHECK(pacing.pause_ns(kStart) == 0);
  pacing.scan_ended(kStart);
  CHECK(pacing.pause_ns(kStart + kMs) == 0);
}

TEST_CASE(
    "no pause reaches within 4 ms of the expected end of the scan, and there are far fewer wake-ups than "
    "packets") {
  for (const std::int64_t period_ns : {50 * kMs, 100 * kMs, 200 * kMs}) {
    const PacketPacing pacing = turning(period_ns);
    const std::int64_t end_ns = kStart + period_ns;
    std::int64_t wake_ups = 0;
    for (std::int64_t now_ns = kStart; now_ns < end_ns; ++wake_ups) {
      const std::int64_t pause_ns = pacing.pause_ns(now_ns);
      if (pause_ns > 0) CHECK(now_ns + pause_ns <= end_ns - 4 * kMs);
      now_ns += pause_ns > 0 ? pause_ns : 1'327'000;  // without a pause: until the next packet of a VLP-16
    }
    CHECK(wake_ups < period_ns / PacketPacing::kPauseNs + 12);  // one wake-up per packet would be 38 to 150
  }
}

TEST_CASE(
    "after a silence or a step back of its clock, packets are fetched at once until two scans give the "
    "period again") {
  PacketPacing pacing = turning(100 * kMs);
  CHECK(pacing.pause_ns(kStart + kMs) > 0);
  CHECK(pacing.pause_ns(kStart + 5'000 * kMs) == 0);
  pacing.scan_ended(kStart + 5'000 * kMs);
  CHECK(pacing.pause_ns(kStart + 5'001 * kMs) == 0);
  pacing.scan_ended(kStart + 100 * kMs);
  CHECK(pacing.pause_ns(kStart + 101 * kMs) == 0);
  pacing.scan_ended(kStart + 200 * kMs);
  CHECK(pacing.pause_ns(kStart + 201 * kMs) > 0);
}

}  // namespace isobar::test::test_packet_pacing
