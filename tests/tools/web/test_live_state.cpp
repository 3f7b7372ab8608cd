// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>

#include "tools/web/live_state.hpp"

namespace isobar::test::test_live_state {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using web::Cursor;
using web::LiveState;
using web::Topic;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a viewer gets the newest of each topic once, and every pose in order") {
  LiveState live;
  Cursor cursor;
  live.put(Topic::kStatus, R"({"old":1})");
  live.put(Topic::kStatus, R"({"new":1})");
  live.add_pose({}, R"({"number":1})");
  live.add_pose({}, R"({"number":2})");
  std::string events;
  REQUIRE(live.wait_for_news(cursor, 0ms, events));
  CHECK(events ==
        "event: status\ndata: {\"new\":1}\n\nevent: pose\ndata: {\"number\":1}\n\nevent: pose\ndata: "
        "{\"number\":2}\n\n");
  CHECK(!live.wait_for_news(cursor, 0ms, events));
  Cursor late;
  std::string all;
  CHECK(live.wait_for_news(late, 0ms, all));
  CHECK(all == events);
}

TEST_CASE("a viewer that is slow misses the oldest poses, and nothing grows") {
  LiveState live;
  Cursor cursor;
  for (int i = 0; i < 10'000; ++i) live.add_pose({}, R"({"number":)" + std::to_string(i) + "}");
  std::string events;
  REQUIRE(live.wait_for_news(cursor, 0ms, events));
  CHECK(count_of(events, "event: pose") == LiveState::kWaitingPoses);
  CHECK(events.find(R"({"number":9999})") != std::string::npos);
}

TEST_CASE("an equal event is sent once") {
  LiveState live;
  Cursor cursor;
  std::string events;
  live.put(Topic::kLink, "{}");
  CHECK(live.wait_for_news(cursor, 0ms, events));
  live.put(Topic::kLink, "{}");
  CHECK(!live.wait_for_news(cursor, 0ms, events));
}

TEST_CASE("a waiting viewer is woken by news and by the end") {
  LiveState live;
  Cursor cursor;
  std::string events;
  std::thread writer([&] {
    std::this_thread::sleep_for(20ms);
    live.put(Topic::kMap, "{}");
  });
  CHECK(live.wait_for_news(cursor, 10s, events));
  writer.join();
  // A stop that came before the news were taken would take their place.
  std::thread ender([&] {
    std::this_thread::sleep_for(20ms);
    live.stop();
  });
  CHECK(!live.wait_for_news(cursor, 10s, events));
  CHECK(live.stopped());
  ender.join();
}

TEST_CASE("the history of a long run is bounded, begins with the run and ends with it, evenly spaced") {
  web::ThinnedRows<int> rows(100);
  for (int i = 0; i < 12'345; ++i) rows.add(i);
  const auto& kept = rows.rows();
  REQUIRE(kept.size() <= 100);
  CHECK(kept.size() >= 50);
  CHECK(kept.front() == 0);
  const int step = kept[1] - kept[0];
  for (std::size_t i = 1; i < kept.size(); ++i) CHECK(kept[i] - kept[i - 1] == step);
  CHECK(kept.back() > 12'345 - 1 - step);
}

}  // namespace isobar::test::test_live_state
