// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/foxglove/protocol.hpp"

namespace isobar::test::test_protocol {

using namespace isobar::tools::foxglove;
using Kind = ViewerRequest::Kind;

TEST_CASE("subscriptions and their ends are read with their numbers") {
  const ViewerRequest subscribe =
      parse_request(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":7,"channelId":1}]})");
  REQUIRE(subscribe.kind == Kind::kSubscribe);
  REQUIRE(subscribe.subscriptions.size() == 2);
  CHECK(subscribe.subscriptions[1].id == 7);
  CHECK(subscribe.subscriptions[1].channel == 1);
  const ViewerRequest unsubscribe = parse_request(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  REQUIRE(unsubscribe.kind == Kind::kUnsubscribe);
  CHECK(unsubscribe.subscriptions.at(0).id == 7);
}

TEST_CASE("what is no request is refused with its reason, whatever it is") {
  for (const char* text :
       {"", "{", "[]", "null", "7", "\"op\"", R"({"op":7})", R"({})", R"({"op":"publish"})",
        R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
        R"({"op":"subscribe","subscriptions":[7]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":4294967296}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1.5}]})",
        R"({"op":"unsubscribe","subscriptionIds":["x"]})", "\xff\xfe"}) {
    const ViewerRequest request = parse_request(text);
    CHECK_MESSAGE(request.kind == Kind::kRefused, text);
    CHECK_FALSE(request.reason.empty());
  }
  CHECK(parse_request(std::string(100'000, '[')).kind == Kind::kRefused);
}

TEST_CASE("texts to a client are JSON that names operation and channels") {
  const std::vector<Channel> channels{{4, "/pose", "a/msg/B", "float64 x\n", false}};
  const auto json = nlohmann::json::parse(advertisement(channels));
  CHECK(json.at("op") == "advertise");
  CHECK(json.at("channels").at(0).at("id") == 4);
  CHECK(json.at("channels").at(0).at("schemaName") == "a/msg/B");
  CHECK(json.at("channels").at(0).at("encoding") == "cdr");
  CHECK(nlohmann::json::parse(server_info("isobar", "1")).at("capabilities").empty());
  CHECK(nlohmann::json::parse(status(1, "broken \xff letter")).at("level") == 1);
}

TEST_CASE("a data message begins with opcode, subscription and time, little endian") {
  std::array<std::uint8_t, kDataHeaderBytes> header{};
  write_data_header(0x01020304, 0x0102030405060708, header);
  CHECK(header == std::array<std::uint8_t, 13>{1, 4, 3, 2, 1, 8, 7, 6, 5, 4, 3, 2, 1});
}

}  // namespace isobar::test::test_protocol
