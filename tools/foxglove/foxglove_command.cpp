// SPDX-License-Identifier: BSD-3-Clause
// `isobar foxglove`: the topics of isobar-dds for Foxglove, live.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "ipc/dds/participant.hpp"
#include "tools/commands.hpp"
#include "tools/foxglove/server.hpp"
#include "tools/foxglove/topic_tap.hpp"
#include "tools/number_option.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct FoxgloveOptions {
  foxglove::ServerAddress address;
  int domain = 0;
  std::string network_interface;
  std::string ros_namespace;
};

volatile std::sig_atomic_t g_stop_serving = 0;

/// Tells apart two runs of the server: a client asks for everything anew.
std::string session_name() { return std::to_string(static_cast<long long>(std::time(nullptr))); }

void say_clients(std::size_t clients) {
  std::printf("%zu viewer%s connected\n", clients, clients == 1 ? "" : "s");
}

void run_foxglove(const FoxgloveOptions& options) {
  dds::ParticipantSettings settings;
  settings.domain_id = options.domain;
  settings.network_interface = options.network_interface;
  const dds::Participant participant(settings);
  if (const auto& missing = participant.interfaces().missing; !missing.empty())
    throw ServiceError("no network interface that is up has the name or address " + missing.front());
  foxglove::TopicTap tap(participant, options.ros_namespace);
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
  command.add_option("--domain", options.domain, "DDS domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(number_within(0, 232))
      ->capture_default_str();
  command
      .add_option("--interface", options.network_interface,
                  "network interfaces beside loopback, by name or address, separated by commas; default: all")
      ->type_name("NAMES");
  command
      .add_option("--namespace", options.ros_namespace,
                  "namespace of the robot, dds.ros_namespace of its configuration")
      ->type_name("NAME");
}

}  // namespace isobar::tools
