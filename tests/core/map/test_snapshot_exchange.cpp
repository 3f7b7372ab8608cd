// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "core/map/snapshot_exchange.hpp"

namespace isobar::test::test_snapshot_exchange {

namespace {

std::atomic<int> alive{0};

// Detects torn reads and use after free: all numbers are equal until the destructor overwrites them.
struct Marked {
  explicit Marked(int value) {
    numbers.fill(value);
    alive.fetch_add(1, std::memory_order_relaxed);
  }
  ~Marked() {
    numbers.fill(-1);
    alive.fetch_sub(1, std::memory_order_relaxed);
  }
  Marked(const Marked&) = delete;
  Marked& operator=(const Marked&) = delete;
  std::array<int, 16> numbers{};
};

}  // namespace

TEST_CASE("a pinned snapshot lives until it is unpinned, and only the writer frees snapshots") {
  {
    isobar::SnapshotExchange<Marked> exchange(std::make_shared<const Marked>(1));
    {
      const auto pin = exchange.pin();
      exchange.publish(std::make_shared<const Marked>(2));
      exchange.publish(std::make_shared<const Marked>(3));
      CHECK(pin->numbers.front() == 1);
      CHECK(alive == 2);  // 1 is pinned, 3 is current; 2 was pinned by nobody
    }
    CHECK(alive == 2);  // unpinning frees nothing
    CHECK(exchange.pin()->numbers.front() == 3);
    exchange.publish(std::make_shared<const Marked>(4));
    CHECK(alive == 1);
  }
  CHECK(alive == 0);
}

TEST_CASE("two readers beside a writer never see a torn snapshot or one older than the last they saw") {
  constexpr int kSwaps = 1'000'000;
  {
    isobar::SnapshotExchange<Marked, 2> exchange(std::make_shared<const Marked>(0));
    std::atomic<bool> stop{false};
    std::array<int, 2> faults{};
    const auto read = [&](std::size_t slot) {
      int newest = 0;
      while (!stop.load(std::memory_order_acquire)) {
        const auto pin = exchange.pin(slot);
        const int value = pin->numbers.front();
        for (const int number : pin->numbers) {
          faults.at(slot) += number != value ? 1 : 0;
        }
        faults.at(slot) += value < newest ? 1 : 0;
        newest = value;
      }
    };
    std::thread first(read, 0);
    std::thread second(read, 1);
    int most_alive = 0;
    for (int i = 1; i <= kSwaps; ++i) {
      exchange.publish(std::make_shared<const Marked>(i));
      most_alive = std::max(most_alive, alive.load(std::memory_order_relaxed));
    }
    stop.store(true, std::memory_order_release);
    first.join();
    second.join();
    CHECK(faults[0] == 0);
    CHECK(faults[1] == 0);
    // At most the current snapshot and two per reader: while the writer checks its list, a reader may release
    // the snapshot found pinned and pin a later one, whose pointer it loaded before the swap.
    CHECK(most_alive <= 5);
    CHECK(exchange.pin()->numbers.front() == kSwaps);
  }
  CHECK(alive == 0);
}

}  // namespace isobar::test::test_snapshot_exchange
