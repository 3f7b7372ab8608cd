// SPDX-License-Identifier: BSD-3-Clause
// `isobar foxglove`: the topics of isobar-dds for Foxglove, live.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <utility>

#include "core/version.hpp"
#include "tools/commands.hpp"
#include "tools/dds_options.hpp"
#include "tools/foxglove/server.hpp"
#include "tools/foxglove/topic_tap.hpp"
#include "tools/number_option.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct FoxgloveOptions {
  foxglove::ServerAddress address;
  DdsOptions dds;
};

volatile std::sig_atomic_t g_stop_serving = 0;

/// Tells apart two runs of the server: a client asks for everything anew.
std::string session_name() { return std::to_string(static_cast<long long>(std::time(nullptr))); }

void say_clients(std::size_t clients) {
  std::printf("%zu viewer%s connected\n", clients, clients == 1 ? "" : "s");
}

void run_foxglove(const FoxgloveOptions& options) {
  const dds::Participant participant = join_dds(options.dds);
  foxglove::TopicTap tap(participant, options.dds.ros_namespace);
  foxglove::Server server(options.address, tap.channels(), session_name());
  std::signal(SIGINT, [](int) { g_stop_serving = 1; });
  std::signal(SIGTERM, [](int) { g_stop_serving = 1; });
  tap.start([&](std::uint32_t channel,
                std::shared_ptr<const foxglove::Data> data) { server.publish(channel, std::move(data)); },
            [&] { server.wake(); });
  std::printf("ready: in Foxglove, open connection, Foxglove WebSocket, ws://%s:%u\n",
              options.address.address.c_str(), unsigned{options.address.port});
  std::size_t clients = 0;
  while (g_stop_serving == 0) {
    server.serve();
    if (server.clients() != clients) say_clients(server.clients());
    clients = server.clients();
  }
  tap.stop();
}

}  // namespace

void add_foxglove_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<FoxgloveOptions>(
      app, "foxglove", "Serve the topics of isobar-dds to Foxglove, live and read-only", run_foxglove);
  command
      .add_option(
          "--listen", options.address.address,
          "IPv4 address of this machine; 0.0.0.0: all, for viewers on the network, without a password")
      ->capture_default_str();
  command.add_option("--port", options.address.port, "TCP port")
      ->check(number_within(1, 65'535))
      ->capture_default_str();
  add_dds_options(command, options.dds);
}

}  // namespace isobar::tools
