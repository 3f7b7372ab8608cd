// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/deadline.hpp"

#include <doctest/doctest.h>

#include <string>

#include "daemon/health_entries.hpp"

namespace isobar::test::test_deadline {

namespace {

constexpr std::int64_t kMs = 1'000'000;

/// The entry of these outputs; its name is empty when there is none.
ipc::HealthEntry entry(const DeadlineStatus& now, const DeadlineStatus& before) {
  ipc::HealthReport report;
  report.entry_count = 0;
  report.entries[0].name[0] = '\0';
  add_deadline(report, "lidar/deadline", now, before, "scans", 1'000 * kMs);
  return report.entries[0];
}

}  // namespace

TEST_CASE("an output at the limit is in time, one beyond it is a miss, and the longest time is kept") {
  Deadline deadline(10.0);
  deadline.note(1'000 * kMs, 1'010 * kMs);
  CHECK(deadline.status().misses == 0);
  deadline.note(1'000 * kMs, 1'010 * kMs + 1);
  deadline.note(1'000 * kMs, 1'250 * kMs);
  deadline.note(1'300 * kMs, 1'304 * kMs);
  CHECK(deadline.status().outputs == 4);
  CHECK(deadline.status().misses == 2);
  CHECK(deadline.status().worst_ns == 250 * kMs);
}

TEST_CASE(
    "a miss is a warning with count, limit and longest time; without a new miss the entry is ok again") {
  Deadline deadline(10.0);
  CHECK(std::string(entry(deadline.status(), {}).name).empty());
  deadline.note(0, 4 * kMs);
  const DeadlineStatus well = deadline.status();
  CHECK(entry(well, {}).level == ipc::HealthLevel::kOk);
  deadline.note(0, 31 * kMs);
  const ipc::HealthEntry late = entry(deadline.status(), well);
  CHECK(late.level == ipc::HealthLevel::kWarning);
  CHECK(late.value == 1.0);
  CHECK(std::string(late.message) == "1 of 2 scans later than 10.0 ms, at most 31.0 ms");
  CHECK(entry(deadline.status(), deadline.status()).level == ipc::HealthLevel::kOk);
}

}  // namespace isobar::test::test_deadline
