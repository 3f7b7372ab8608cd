// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/scan_queue.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

namespace isobar::test::test_scan_queue {

namespace {

using isobar::DroppedScan;
using isobar::ScanQueueConfig;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kRevolution = 100 * kMs;

struct FakeScan {
  std::uint32_t sequence = 0;
  std::int64_t end_stamp_ns = 0;
};
using Queue = isobar::ScanQueue<std::unique_ptr<FakeScan>>;

/// Scan with this sequence number of a lidar at 10 Hz; number 0 ends at time 0.
std::unique_ptr<FakeScan> scan(std::uint32_t sequence) {
  return std::make_unique<FakeScan>(FakeScan{sequence, sequence * kRevolution});
}

std::vector<std::uint32_t> numbers(const Queue& queue) {
  std::vector<std::uint32_t> result;
  for (const DroppedScan& dropped : queue.dropped()) result.push_back(dropped.sequence);
  return result;
}

}  // namespace

TEST_CASE("scans that arrive one by one are all registered, each as soon as the priors reach its end") {
  Queue queue(ScanQueueConfig{.reach_ns = 6 * kMs, .wait_ns = 50 * kMs});
  for (std::uint32_t i = 0; i < 100; ++i) {
    const std::int64_t end_ns = i * kRevolution;
    queue.push(scan(i), i * kRevolution);
    CHECK_FALSE(queue.take(end_ns + kMs, end_ns - 7 * kMs));
    const auto taken = queue.take(end_ns + kMs, end_ns - 6 * kMs);
    REQUIRE(taken);
    CHECK(taken->sequence == i);
    CHECK(queue.empty());
  }
  CHECK(queue.dropped_count() == 0);
  CHECK(queue.dropped().empty());
}

TEST_CASE("a scan without priors is registered once it has waited long enough") {
  Queue queue(ScanQueueConfig{.reach_ns = 6 * kMs, .wait_ns = 50 * kMs});
  queue.push(scan(3), 310 * kMs);  // arrives 10 ms after its end; the wait counts from here
  CHECK_FALSE(queue.take(360 * kMs - 1, 0));
  CHECK_FALSE(queue.empty());
  CHECK(queue.take(360 * kMs, 0));
  CHECK(queue.dropped_count() == 0);
}

TEST_CASE("after a stall the newest scan is registered, and the older ones are listed as dropped, in order") {
  Queue queue(ScanQueueConfig{});
  for (std::uint32_t i = 5; i < 8; ++i) queue.push(scan(i), i * kRevolution);
  const auto taken = queue.take(700 * kMs, 700 * kMs);
  REQUIRE(taken);
  CHECK(taken->sequence == 7);
  CHECK(numbers(queue) == std::vector<std::uint32_t>{5, 6});
  CHECK(queue.dropped()[1].end_stamp_ns == 600 * kMs);
  CHECK(queue.dropped_count() == 2);
  queue.forget_dropped();
  CHECK(queue.dropped().empty());
  CHECK(queue.dropped_count() == 2);
  CHECK_FALSE(queue.take(800 * kMs, 800 * kMs));
}

TEST_CASE("a scan that still waits for its priors does not displace an older one that has them") {
  Queue queue(ScanQueueConfig{});
  queue.push(scan(1), 1 * kRevolution);
  queue.push(scan(2), 2 * kRevolution);
  CHECK(queue.take(205 * kMs, 150 * kMs)->sequence == 1);
  CHECK(queue.dropped_count() == 0);
  CHECK(queue.take(206 * kMs, 200 * kMs)->sequence == 2);
}

TEST_CASE("lost scans are listed between their neighbours, with interpolated end times") {
  Queue queue(ScanQueueConfig{});
  queue.push(scan(1), 1 * kRevolution);
  CHECK(queue.take(100 * kMs, 100 * kMs));
  queue.push(scan(4), 4 * kRevolution);
  queue.push(scan(6), 6 * kRevolution);
  CHECK(queue.take(600 * kMs, 600 * kMs)->sequence == 6);
  CHECK(numbers(queue) == std::vector<std::uint32_t>{2, 3, 4, 5});
  for (const DroppedScan& dropped : queue.dropped())
    CHECK(dropped.end_stamp_ns == dropped.sequence * kRevolution);
}

TEST_CASE("a full queue drops its oldest scan, although none has its priors") {
  Queue queue(ScanQueueConfig{});
  for (std::uint32_t i = 0; i < Queue::kMaxWaiting + 2; ++i) queue.push(scan(i), i * kRevolution);
  CHECK(numbers(queue) == std::vector<std::uint32_t>{0, 1});
  CHECK(queue.take(2 * kRevolution + 50 * kMs, 0)->sequence == 2);
}

TEST_CASE("a gap longer than the list is counted in full, and the newest scans are listed") {
  Queue queue(ScanQueueConfig{});
  queue.push(scan(0), 0 * kRevolution);
  CHECK(queue.take(0, 0));
  queue.push(scan(101), 101 * kRevolution);
  CHECK(queue.take(101 * kRevolution, 101 * kRevolution));
  CHECK(queue.dropped_count() == 100);
  REQUIRE(queue.dropped().size() == Queue::kMaxListed);
  CHECK(queue.dropped().back().sequence == 100);
  CHECK(queue.dropped().front().sequence == 101 - Queue::kMaxListed);
}

TEST_CASE("neither a wrapped nor a restarted sequence number is a gap") {
  Queue queue(ScanQueueConfig{});
  queue.push(std::make_unique<FakeScan>(FakeScan{UINT32_MAX, 0}), 0);
  CHECK(queue.take(0, 0));
  queue.push(std::make_unique<FakeScan>(FakeScan{0, kRevolution}), kRevolution);
  CHECK(queue.take(kRevolution, kRevolution));
  queue.push(std::make_unique<FakeScan>(FakeScan{70, 2 * kRevolution}), 2 * kRevolution);
  CHECK(queue.take(2 * kRevolution, 2 * kRevolution));
  CHECK(queue.dropped_count() == 69);
  queue.push(std::make_unique<FakeScan>(FakeScan{0, 3 * kRevolution}), 3 * kRevolution);
  CHECK(queue.take(3 * kRevolution, 3 * kRevolution));
  CHECK(queue.dropped_count() == 69);
}

TEST_CASE(
    "in lock step every scan is registered in order: with its priors, when the queue is full, or at the "
    "end") {
  Queue queue(ScanQueueConfig{.reach_ns = 0, .wait_ns = 1, .admission = isobar::ScanAdmission::kEvery});
  for (std::uint32_t i = 1; i <= 4; ++i) queue.push(scan(i), 0);
  CHECK_FALSE(queue.take(0, kRevolution - 1));
  REQUIRE(queue.take(0, kRevolution)->sequence == 1);  // the prior reaches the end of scan 1 only
  CHECK_FALSE(queue.take(0, kRevolution));
  for (std::uint32_t i = 5; i <= 6; ++i) queue.push(scan(i), 0);
  REQUIRE(queue.take(0, kRevolution)->sequence == 2);  // five wait: the oldest goes on without its priors
  CHECK_FALSE(queue.take(0, kRevolution));
  for (std::uint32_t i = 3; i <= 6; ++i) REQUIRE(queue.take(1, kRevolution)->sequence == i);
  CHECK(queue.empty());
  CHECK(queue.dropped_count() == 0);
}

}  // namespace isobar::test::test_scan_queue
