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

// Says whether it is whole: all numbers alike, none overwritten by the destructor.
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

TEST_CASE("what is pinned lives until it is let go, and only the writer frees") {
  {
    isobar::SnapshotExchange<Marked> exchange(std::make_shared<const Marked>(1));
    {
      const auto pin = exchange.pin();
      exchange.publish(std::make_shared<const Marked>(2));
      exchange.publish(std::make_shared<const Marked>(3));
      CHECK(pin->numbers.front() == 1);
      CHECK(exchange.retired_count() == 1);  // 2 was pinned by nobody
      CHECK(alive == 2);
    }
    CHECK(alive == 2);  // letting go frees nothing
    CHECK(exchange.pin()->numbers.front() == 3);
    exchange.publish(std::make_shared<const Marked>(4));
    CHECK(exchange.retired_count() == 0);
    CHECK(alive == 1);
  }
  CHECK(alive == 0);
}

TEST_CASE("two readers beside a writer that swaps always see a whole and never an older snapshot") {
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
    std::size_t most_retired = 0;
    for (int i = 1; i <= kSwaps; ++i) {
      exchange.publish(std::make_shared<const Marked>(i));
      most_retired = std::max(most_retired, exchange.retired_count());
    }
    stop.store(true, std::memory_order_release);
    first.join();
    second.join();
    CHECK(faults[0] == 0);
    CHECK(faults[1] == 0);
    // Two a reader: while the writer looks through its list, a reader may let go of one snapshot that was
    // seen pinned and be about to take a later one, which it read before the swap.
    CHECK(most_retired <= 4);
    CHECK(exchange.pin()->numbers.front() == kSwaps);
  }
  CHECK(alive == 0);
}

}  // namespace isobar::test::test_snapshot_exchange
