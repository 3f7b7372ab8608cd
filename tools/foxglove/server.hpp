// SPDX-License-Identifier: BSD-3-Clause
// WebSocket server of Foxglove's protocol: topics to any number of viewers, up to a limit. Read-only.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "tools/foxglove/client_queue.hpp"
#include "tools/foxglove/protocol.hpp"

struct lws;
struct lws_context;

namespace isobar::tools::foxglove {

/// Where the server listens.
struct ServerAddress {
  std::string address = "127.0.0.1";  ///< IPv4 address of this machine
  std::uint16_t port = 8765;          ///< of Foxglove's own bridges
};

class Server {
 public:
  static constexpr std::size_t kMaxClients = 16;
  static constexpr std::size_t kMaxRequestBytes = 64U << 10U;

  /// @throws ServiceError when the port cannot be opened
  Server(const ServerAddress& address, std::vector<Channel> channels, std::string session);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Serves until the next wake(). Belongs to one thread.
  void serve();
  /// Ends serve(). From any thread.
  void wake() noexcept;
  /// Hands a message of a channel to the clients that want it. From any thread, also while serve() runs.
  void publish(std::uint32_t channel, std::shared_ptr<const Data> data);

  [[nodiscard]] std::size_t clients() const { return clients_.size(); }  ///< thread of serve()
  /// Called by the library, thread of serve(). @return non-zero closes the connection
  int on_event(lws* connection, int reason, void* bytes, std::size_t length);

 private:
  struct Client {
    ClientQueue queue;
    std::map<std::uint32_t, std::uint32_t> channels;  ///< by the number of the subscription
    std::string request;                              ///< pieces that have come
    std::uint64_t told_dropped = 0;
  };
  struct Inbound {
    std::uint32_t channel;
    std::shared_ptr<const Data> data;
  };
  struct ContextDeleter {
    void operator()(lws_context* context) const noexcept;
  };

  void welcome(lws* connection);
  int receive(lws* connection, std::string_view piece);
  void answer(lws* connection, const ViewerRequest& request);
  void subscribe(lws* connection, Client& client, const ViewerRequest::Subscription& wanted);
  void send(lws* connection, Outgoing message);
  int write_next(lws* connection);
  void tell_dropped(Client& client);
  void distribute();

  std::vector<Channel> channels_;
  std::string session_;
  std::map<lws*, Client> clients_;
  std::map<std::uint32_t, std::shared_ptr<const Data>> latched_;  ///< last message of each latched channel
  std::mutex mutex_;
  std::vector<Inbound> inbox_;  ///< guarded by mutex_
  std::vector<std::uint8_t> buffer_;
  std::unique_ptr<lws_context, ContextDeleter> context_;
};

}  // namespace isobar::tools::foxglove
