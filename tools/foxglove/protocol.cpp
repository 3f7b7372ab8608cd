// SPDX-License-Identifier: BSD-3-Clause
#include "tools/foxglove/protocol.hpp"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

namespace isobar::tools::foxglove {

namespace {

using Json = nlohmann::json;

constexpr std::uint8_t kDataOpcode = 1;

static_assert(std::endian::native == std::endian::little, "numbers are sent as their bytes in memory");

ViewerRequest refused(std::string reason) { return {ViewerRequest::Kind::kRefused, {}, std::move(reason)}; }

/// A number of 32 bits; false for anything else.
bool take_number(const Json& from, std::uint32_t& to) {
  if (!from.is_number_unsigned() || from.get<std::uint64_t>() > UINT32_MAX) return false;
  to = from.get<std::uint32_t>();
  return true;
}

ViewerRequest subscribe_request(const Json& json) {
  ViewerRequest request{ViewerRequest::Kind::kSubscribe};
  const auto list = json.find("subscriptions");
  if (list == json.end() || !list->is_array()) return refused("subscribe: \"subscriptions\" must be a list");
  for (const Json& entry : *list) {
    ViewerRequest::Subscription one;
    if (!entry.is_object() || !take_number(entry.value("id", Json()), one.id) ||
        !take_number(entry.value("channelId", Json()), one.channel))
      return refused("subscribe: a subscription must have the numbers \"id\" and \"channelId\"");
    request.subscriptions.push_back(one);
  }
  return request;
}

ViewerRequest unsubscribe_request(const Json& json) {
  ViewerRequest request{ViewerRequest::Kind::kUnsubscribe};
  const auto list = json.find("subscriptionIds");
  if (list == json.end() || !list->is_array())
    return refused("unsubscribe: \"subscriptionIds\" must be a list");
  for (const Json& entry : *list) {
    ViewerRequest::Subscription one;
    if (!take_number(entry, one.id)) return refused("unsubscribe: \"subscriptionIds\" must hold numbers");
    request.subscriptions.push_back(one);
  }
  return request;
}

}  // namespace

std::string server_info(std::string_view name, std::string_view session) {
  return Json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", Json::array()},
              {"supportedEncodings", Json::array()},
              {"metadata", Json::object()},
              {"sessionId", session}}
      .dump();
}

std::string advertisement(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.ros_type},
                    {"schema", channel.definition},
                    {"schemaEncoding", "ros2msg"}});
  }
  return Json{{"op", "advertise"}, {"channels", std::move(list)}}.dump();
}

std::string status(int level, std::string_view message) {
  return Json{{"op", "status"}, {"level", level}, {"message", message}}.dump(-1, ' ', false,
                                                                             Json::error_handler_t::replace);
}

ViewerRequest parse_request(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return refused("a request must be a JSON object");
  const auto op = json.find("op");
  if (op == json.end() || !op->is_string()) return refused("a request must name its operation, \"op\"");
  const auto name = op->get<std::string>();
  if (name == "subscribe") return subscribe_request(json);
  if (name == "unsubscribe") return unsubscribe_request(json);
  return refused("operation \"" + name.substr(0, 40) + "\" is not offered: this server is read-only");
}

void write_data_header(std::uint32_t subscription, std::int64_t stamp_ns,
                       std::span<std::uint8_t, kDataHeaderBytes> out) {
  out[0] = kDataOpcode;
  std::memcpy(out.data() + 1, &subscription, sizeof subscription);
  std::memcpy(out.data() + 1 + sizeof subscription, &stamp_ns, sizeof stamp_ns);
}

}  // namespace isobar::tools::foxglove
