// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/mailbox.hpp"

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <thread>

namespace isobar::test::test_mailbox {

namespace {

/// A value that shows when it is put together from two writes.
struct Twelve {
  std::array<std::uint64_t, 12> words{};
};

Twelve filled_with(std::uint64_t number) {
  Twelve value;
  value.words.fill(number);
  return value;
}

}  // namespace

TEST_CASE("a mailbox starts with a default value and holds the last one put in") {
  isobar::Mailbox<Twelve> mailbox;
  CHECK(mailbox.get().words[11] == 0);
  mailbox.put(filled_with(3));
  mailbox.put(filled_with(7));
  CHECK(mailbox.get().words[0] == 7);
  CHECK(mailbox.get().words[11] == 7);
}

TEST_CASE("a reader never sees half of one value and half of another, nor an older one after a newer one") {
  isobar::Mailbox<Twelve> mailbox;
  constexpr std::uint64_t kWrites = 100'000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) mailbox.put(filled_with(i));
    done = true;
  });
  std::uint64_t newest = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  bool last_round = false;
  while (!last_round) {
    last_round = done;
    const Twelve value = mailbox.get();
    for (const std::uint64_t word : value.words) torn += word != value.words[0] ? 1 : 0;
    backwards += value.words[0] < newest ? 1 : 0;
    newest = value.words[0];
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backwards == 0);
  CHECK(newest == kWrites);
}

}  // namespace isobar::test::test_mailbox
