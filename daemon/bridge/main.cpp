// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds: the bridge between isobard's shared memory and DDS.
//
// It is a process of its own, so that no fault in a network parser reaches the estimator. It waits for
// isobard as long as it takes; when isobard goes, it starts itself over, because a process cannot attach to
// shared memory twice.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "daemon/bridge/forwarding.hpp"
#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/process.hpp"
#include "daemon/bridge/receiving.hpp"
#include "daemon/bridge/settings.hpp"
#include "ipc/dds/discovery.hpp"
#include "ipc/dds/participant.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// isobard sends hundreds of priors a second and its health every second. After this long without anything
/// the way through shared memory is broken (this process was stopped for so long that it was given up, say).
constexpr auto kMaxSilence = 5s;
/// Joining takes milliseconds. An isobard that ends in the middle of it leaves the library waiting.
constexpr auto kJoiningLimit = 10s;
/// Leaving takes less than a second, but for the same fault.
constexpr auto kLeavingLimit = 4s;

/// Everything on the DDS side.
struct Network {
  dds::Participant participant;
  Outputs outputs;
  dds::NodeAnnouncement announcement;

  explicit Network(const Settings& settings)
      : participant({settings.dds.domain_id, settings.dds.network_interface, settings.dds.max_message_bytes}),
        outputs(participant.get(), settings),
        announcement(participant.get(), settings.dds.ros_gid_bytes) {
    announce(settings, {});
  }

  /// Tells ROS 2 tools what belongs to this node.
  void announce(const Settings& settings, const std::vector<dds_entity_t>& readers) {
    announcement.announce(settings.dds.ros_namespace, settings.dds.node_name, outputs.writers(), readers);
  }
};

/// Null when the program was told to end meanwhile.
std::unique_ptr<ipc::Attachment> wait_for_isobard(Network& network, const Settings& settings,
                                                  StopSignals& signals, const ServiceManager& manager) {
  dds::DiagnosticsBuilder builder(settings.dds.node_name);
  for (bool told = false; !signals.wait_for(0ms);) {
    manager.alive();
    limit_time(kJoiningLimit, &replace_process);
    try {
      return std::make_unique<ipc::Attachment>("isobar-dds", manager.interval());
    } catch (const ServiceError& error) {
      if (!told) {
        spdlog::info("{}; waiting for it", error.what());
        manager.status("waiting for isobard");
        told = true;
      }
      report_absence(network.outputs, builder);
    }
  }
  lift_time_limit();
  return nullptr;
}

/// Why the bridge has to start over, if it has to.
std::optional<std::string> reason_to_restart(const ipc::Attachment& attachment, const Forwarding& forwarding,
                                             bool on_lonely_loopback) {
  if (!attachment.broker_alive()) {
    return "isobard has gone";
  }
  if (forwarding.silence() > kMaxSilence) {
    return "isobard has been silent for " + std::to_string(kMaxSilence.count()) + " s";
  }
  if (on_lonely_loopback && dds::loopback_if_alone().empty()) {
    return "a network has come up";
  }
  return std::nullopt;
}

/// Returns when told to end; starts over when it must.
void forward(Network& network, const Settings& settings, const ipc::Attachment& attachment,
             StopSignals& signals, const ServiceManager& manager) {
  limit_time(kJoiningLimit, &replace_process);
  Forwarding forwarding(network.outputs, settings.dds);
  const Receiving receiving(network.participant.get(), settings, forwarding.clock());
  lift_time_limit();
  network.announce(settings, receiving.readers());
  manager.status("forwarding");
  spdlog::info("attached to isobard");
  const bool on_lonely_loopback =
      settings.dds.network_interface.empty() && !network.participant.network_interface().empty();
  std::uint64_t rounds = 0;
  while (!signals.wait_for(manager.interval())) {
    if (forwarding.rounds() != rounds) {
      rounds = forwarding.rounds();
      manager.alive();
    }
    forwarding.note_received(receiving.counts());
    if (const auto reason = reason_to_restart(attachment, forwarding, on_lonely_loopback)) {
      spdlog::warn("{}; starting over", *reason);
      // The readers learn that this participant ends. Nothing of shared memory is cleaned up: with isobard
      // gone it cannot be, and the new program starts without it.
      dds_delete(network.participant.get());
      replace_process();
    }
  }
  limit_time(kLeavingLimit, &end_process);  // never lifted: the library takes its leave after main()
}

int run(const Settings& settings) {
  StopSignals signals;
  const ServiceManager manager;
  ipc::set_fatal_action(&replace_process_later);
  Network network(settings);
  const std::string& interface = network.participant.network_interface();
  spdlog::info("DDS domain {} on {}", settings.dds.domain_id, interface.empty() ? "the network" : interface);
  manager.ready("DDS is up");
  if (const auto attachment = wait_for_isobard(network, settings, signals, manager)) {
    forward(network, settings, *attachment, signals, manager);
  }
  manager.stopping();
  spdlog::info("stopped");
  return 0;
}

}  // namespace
}  // namespace isobar::bridge

int main(int argc, char** argv) {
  isobar::bridge::remember_arguments(argv);
  spdlog::set_default_logger(spdlog::stderr_logger_mt("isobar-dds"));
  spdlog::set_pattern("%n: %l: %v");
  CLI::App app("isobar-dds: publishes what isobard estimates over DDS, as ROS 2 nodes understand it");
  isobar::bridge::Options options;
  isobar::bridge::add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 64;
  }
  try {
    return isobar::bridge::run(isobar::bridge::load_settings(options));
  } catch (const isobar::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 70;
  }
}
