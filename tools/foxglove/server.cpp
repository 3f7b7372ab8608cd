// SPDX-License-Identifier: BSD-3-Clause
#include "tools/foxglove/server.hpp"

#include <libwebsockets.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/errors.hpp"

namespace isobar::tools::foxglove {

namespace {

// Messages that wait for distribution beyond this are dropped, oldest first: the serving thread hangs.
constexpr std::size_t kMostInbound = 4096;

int on_library_event(lws* connection, lws_callback_reasons reason, void* /*user*/, void* bytes,
                     std::size_t length) {
  auto* server = static_cast<Server*>(lws_context_user(lws_get_context(connection)));
  return server == nullptr ? 0 : server->on_event(connection, reason, bytes, length);
}

/// Both names of the protocol that Foxglove's clients ask for.
constexpr std::array<lws_protocols, 3> kProtocols{{
    {"foxglove.websocket.v1", on_library_event, 0, Server::kMaxRequestBytes, 0, nullptr, 0},
    {"foxglove.sdk.v1", on_library_event, 0, Server::kMaxRequestBytes, 0, nullptr, 0},
    {nullptr, nullptr, 0, 0, 0, nullptr, 0},
}};

}  // namespace

void Server::ContextDeleter::operator()(lws_context* context) const noexcept { lws_context_destroy(context); }

Server::Server(const ServerAddress& address, std::vector<Channel> channels, std::string session)
    : channels_(std::move(channels)), session_(std::move(session)) {
  lws_set_log_level(0, nullptr);  // errors are told by return values
  lws_context_creation_info info{};
  info.iface = address.address.c_str();
  info.port = address.port;
  info.protocols = kProtocols.data();
  info.user = this;
  info.gid = -1;
  info.uid = -1;
  info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
  context_.reset(lws_create_context(&info));
  if (!context_)
    throw ServiceError("port " + std::to_string(address.port) + " of " + address.address +
                       " cannot be opened; is it in use?");
}

Server::~Server() {
  clients_.clear();
  context_.reset();  // calls on_event() for each connection that is left
}

void Server::serve() { lws_service(context_.get(), 0); }

void Server::wake() noexcept { lws_cancel_service(context_.get()); }

void Server::publish(std::uint32_t channel, std::shared_ptr<const Data> data) {
  {
    const std::lock_guard lock(mutex_);
    if (inbox_.size() >= kMostInbound) inbox_.erase(inbox_.begin());
    inbox_.push_back({channel, std::move(data)});
  }
  wake();
}

int Server::on_event(lws* connection, int reason, void* bytes, std::size_t length) {
  switch (reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
      return clients_.size() >= kMaxClients ? 1 : 0;
    case LWS_CALLBACK_ESTABLISHED:
      welcome(connection);
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return receive(connection, {static_cast<const char*>(bytes), length});
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return write_next(connection);
    case LWS_CALLBACK_CLOSED:
      clients_.erase(connection);
      return 0;
    case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
      distribute();
      return 0;
    default:
      return 0;
  }
}

void Server::welcome(lws* connection) {
  clients_[connection];
  send(connection, {.text = server_info("isobar", session_)});
  send(connection, {.text = advertisement(channels_)});
}

int Server::receive(lws* connection, std::string_view piece) {
  const auto found = clients_.find(connection);
  if (found == clients_.end()) return 1;
  Client& client = found->second;
  if (client.request.size() + piece.size() > kMaxRequestBytes)
    return 1;  // no request of the protocol is as long
  client.request += piece;
  if (lws_is_final_fragment(connection) == 0 || lws_remaining_packet_payload(connection) > 0) return 0;
  const std::string text = std::exchange(client.request, {});
  answer(connection,
         lws_frame_is_binary(connection) != 0
             ? ViewerRequest{ViewerRequest::Kind::kRefused, {}, "binary messages of clients are not taken"}
             : parse_request(text));
  return 0;
}

void Server::answer(lws* connection, const ViewerRequest& request) {
  Client& client = clients_.at(connection);
  switch (request.kind) {
    case ViewerRequest::Kind::kSubscribe:
      for (const ViewerRequest::Subscription& one : request.subscriptions) subscribe(connection, client, one);
      return;
    case ViewerRequest::Kind::kUnsubscribe:
      for (const ViewerRequest::Subscription& one : request.subscriptions) {
        client.channels.erase(one.id);
        client.queue.forget(one.id);
      }
      return;
    case ViewerRequest::Kind::kRefused:
      send(connection, {.text = status(2, request.reason)});
      return;
  }
}

void Server::subscribe(lws* connection, Client& client, const ViewerRequest::Subscription& wanted) {
  const bool exists = std::any_of(channels_.begin(), channels_.end(),
                                  [&](const Channel& channel) { return channel.id == wanted.channel; });
  if (!exists || client.channels.size() >= 4 * channels_.size()) {
    send(connection, {.text = status(2, "there is no channel " + std::to_string(wanted.channel))});
    return;
  }
  client.channels[wanted.id] = wanted.channel;
  const auto last = latched_.find(wanted.channel);
  if (last != latched_.end()) send(connection, {.text = {}, .data = last->second, .subscription = wanted.id});
}

void Server::send(lws* connection, Outgoing message) {
  clients_.at(connection).queue.push(std::move(message));
  lws_callback_on_writable(connection);
}

void Server::tell_dropped(Client& client) {
  if (client.queue.dropped() == client.told_dropped) return;
  client.told_dropped = client.queue.dropped();
  client.queue.push({.text = status(1, "this viewer reads too slowly: " +
                                           std::to_string(client.told_dropped) + " messages were left out")});
}

int Server::write_next(lws* connection) {
  const auto found = clients_.find(connection);
  if (found == clients_.end()) return 1;
  Client& client = found->second;
  if (client.queue.empty()) return 0;
  const Outgoing message = client.queue.pop();
  const std::size_t header = message.data ? kDataHeaderBytes : 0;
  const std::size_t length = header + message.bytes();
  buffer_.resize(LWS_PRE + length);
  std::uint8_t* begin = buffer_.data() + LWS_PRE;
  if (message.data) {
    write_data_header(message.subscription, message.data->stamp_ns,
                      std::span<std::uint8_t, kDataHeaderBytes>(begin, kDataHeaderBytes));
    std::copy(message.data->cdr.begin(), message.data->cdr.end(), begin + header);
  } else {
    std::copy(message.text.begin(), message.text.end(), begin);
  }
  // What the socket does not take at once, the library keeps and sends before the next message.
  const int written = lws_write(connection, begin, length, message.data ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
  if (written < 0) return 1;
  if (client.queue.empty()) tell_dropped(client);
  if (!client.queue.empty()) lws_callback_on_writable(connection);
  return 0;
}

void Server::distribute() {
  std::vector<Inbound> arrived;
  {
    const std::lock_guard lock(mutex_);
    arrived.swap(inbox_);
  }
  for (const auto& [number, data] : arrived) {
    const auto channel = std::find_if(channels_.begin(), channels_.end(),
                                      [number = number](const Channel& one) { return one.id == number; });
    if (channel != channels_.end() && channel->is_latched) latched_[number] = data;
    for (auto& [connection, client] : clients_) {
      for (const auto& [subscription, wanted] : client.channels) {
        if (wanted == number) send(connection, {.text = {}, .data = data, .subscription = subscription});
      }
    }
  }
}

}  // namespace isobar::tools::foxglove
