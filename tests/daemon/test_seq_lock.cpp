// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/seq_lock.hpp"

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <thread>

namespace isobar::test::test_seq_lock {

namespace {

/// A value that shows a torn read: all words of one write are equal.
struct Twelve {
  std::array<std::uint64_t, 12> words{};
};

Twelve filled_with(std::uint64_t number) {
  Twelve value;
  value.words.fill(number);
  return value;
}

}  // namespace

TEST_CASE("a sequence lock holds a default value first and then the last one written") {
  SeqLock<Twelve> lock;
  CHECK(lock.get().words[11] == 0);
  lock.put(filled_with(3));
  lock.put(filled_with(7));
  CHECK(lock.get().words[0] == 7);
  CHECK(lock.get().words[11] == 7);
}

TEST_CASE("a reader never sees a torn value, nor an older value after a newer one") {
  SeqLock<Twelve> lock;
  constexpr std::uint64_t kWrites = 100'000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) lock.put(filled_with(i));
    done = true;
  });
  std::uint64_t newest = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  bool last_round = false;
  while (!last_round) {
    last_round = done;
    const Twelve value = lock.get();
    for (const std::uint64_t word : value.words) torn += word != value.words[0] ? 1 : 0;
    backwards += value.words[0] < newest ? 1 : 0;
    newest = value.words[0];
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backwards == 0);
  CHECK(newest == kWrites);
}

}  // namespace isobar::test::test_seq_lock
