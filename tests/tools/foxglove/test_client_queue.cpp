// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <memory>

#include "tools/foxglove/client_queue.hpp"

namespace isobar::test::test_client_queue {

using namespace isobar::tools::foxglove;

namespace {

Outgoing data_of(std::size_t bytes, std::uint32_t subscription) {
  return {.text = {},
          .data = std::make_shared<Data>(Data{0, std::vector<std::uint8_t>(bytes)}),
          .subscription = subscription};
}

}  // namespace

TEST_CASE("messages leave in the order in which they came") {
  ClientQueue queue(1000);
  queue.push({.text = "a"});
  queue.push(data_of(10, 1));
  queue.push({.text = "b"});
  CHECK(queue.bytes() == 12);
  CHECK(queue.pop().text == "a");
  CHECK(queue.pop().subscription == 1);
  CHECK(queue.pop().text == "b");
  CHECK(queue.empty());
  CHECK(queue.bytes() == 0);
}

TEST_CASE(
    "a client that stops reading loses the oldest data, no text, and takes no more memory than the limit") {
  ClientQueue queue(100);
  queue.push({.text = "info"});
  for (std::uint32_t i = 0; i < 1000; ++i) queue.push(data_of(30, i));
  CHECK(queue.bytes() <= 100);
  CHECK(queue.dropped() == 997);
  CHECK(queue.pop().text == "info");
  CHECK(queue.pop().subscription == 997);
}

TEST_CASE("a message that is larger than the limit is kept, alone") {
  ClientQueue queue(100);
  queue.push(data_of(50, 1));
  queue.push(data_of(5000, 2));
  CHECK(queue.pop().subscription == 2);
  CHECK(queue.empty());
}

TEST_CASE("what waits for a subscription goes with it") {
  ClientQueue queue(1000);
  queue.push(data_of(10, 1));
  queue.push(data_of(20, 2));
  queue.push(data_of(30, 1));
  queue.forget(1);
  CHECK(queue.bytes() == 20);
  CHECK(queue.pop().subscription == 2);
  CHECK(queue.dropped() == 0);
}

}  // namespace isobar::test::test_client_queue
