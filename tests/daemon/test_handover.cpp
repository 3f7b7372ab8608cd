// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handover.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace isobar::test::test_handover {

namespace {

struct Counted {
  explicit Counted(int number) : value(number) { ++alive; }
  ~Counted() { --alive; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  int value;
  static inline std::atomic<int> alive{0};
};

}  // namespace

TEST_CASE("the worker takes the newest object once, and the main thread frees it") {
  Handover<Counted> handover;
  int taken = 0;
  const auto take = [&] { handover.take([&](Counted& object) { taken = object.value; }); };
  take();
  CHECK(taken == 0);
  handover.offer(std::make_unique<Counted>(1));
  handover.offer(std::make_unique<Counted>(2));
  CHECK(Counted::alive == 1);
  take();
  CHECK(taken == 2);
  CHECK(Counted::alive == 1);
  handover.collect();
  CHECK(Counted::alive == 0);
}

TEST_CASE("under contention every object is freed exactly once and the last one arrives") {
  constexpr int kObjects = 20'000;
  {
    Handover<Counted> handover;
    std::atomic<int> taken{0};
    std::thread worker([&] {
      while (taken < kObjects) {
        handover.take([&](Counted& object) {
          CHECK(object.value > taken);
          taken = object.value;
        });
      }
    });
    for (int i = 1; i <= kObjects; ++i) handover.offer(std::make_unique<Counted>(i));
    while (taken < kObjects) handover.collect();
    worker.join();
  }
  CHECK(Counted::alive == 0);
}

}  // namespace isobar::test::test_handover
