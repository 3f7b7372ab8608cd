// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds: the bridge between isobard's shared memory and DDS.
//
// A process of its own, so that a fault in a network parser cannot reach the estimator. Waits for isobard
// without limit. Restarts itself in place when isobard ends, because a process can attach to shared memory
// only once.
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
#include "daemon/logging.hpp"
#include "daemon/service.hpp"
#include "ipc/dds/discovery.hpp"
#include "ipc/dds/participant.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest wait for isobard in one round of the supervise loop; stop signals are seen between two rounds.
constexpr auto kAttachTimeout = 400ms;
/// Longest silence of a running isobard: it sends hundreds of priors a second and its health once a
/// second. After a longer one this process is no longer connected, for instance because iceoryx
/// unregistered it while it was stopped.
constexpr auto kMaxSilence = 5s;
/// Time limit for attaching: milliseconds, but it blocks for ever when isobard ends in the middle of it.
constexpr auto kAttachLimit = 10s;
/// Time limit for detaching: less than a second, but it blocks for ever when isobard hangs.
constexpr auto kDetachLimit = 4s;

/// The DDS side.
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

  /// Publishes which writers and readers belong to this ROS 2 node.
  void announce(const Settings& settings, const std::vector<dds_entity_t>& readers) {
    announcement.announce(settings.dds.ros_namespace, settings.dds.node_name, outputs.writers(), readers);
  }
};

/// The shared-memory side and both directions of forwarding, from attaching to isobard until the end.
class Connection {
 public:
  Connection(std::unique_ptr<ipc::Attachment> attachment, Network& network, const Settings& settings)
      : attachment_(std::move(attachment)),
        network_(network),
        forwarding_(network.outputs, settings.dds),
        receiving_(network.participant.get(), settings, forwarding_.clock()),
        watches_for_network_(settings.dds.network_interface.empty() &&
                             !network.participant.network_interface().empty()) {
    network.announce(settings, receiving_.readers());
  }

  /// One round of the supervise loop. Restarts the process when the connection has become useless.
  /// @return true when the pose thread has completed a round since the last call
  bool check() {
    forwarding_.put_received(receiving_.counts());
    if (const auto reason = reason_to_restart()) {
      spdlog::warn("{}; restarting", *reason);
      // dds_delete tells remote readers that this participant ends. No detaching from shared memory: that
      // blocks without isobard, and the restarted program does not need it.
      dds_delete(network_.participant.get());
      replace_process();
    }
    const std::uint64_t rounds_before = rounds_;
    rounds_ = forwarding_.rounds();
    return rounds_ != rounds_before;
  }

 private:
  [[nodiscard]] std::optional<std::string> reason_to_restart() const {
    if (!attachment_->broker_alive()) return "isobard has ended";
    if (forwarding_.silence() > kMaxSilence) {
      return "no message from isobard for " + std::to_string(kMaxSilence.count()) + " s";
    }
    if (watches_for_network_ && dds::loopback_if_alone().empty()) return "a network interface is up";
    return std::nullopt;
  }

  std::unique_ptr<ipc::Attachment> attachment_;
  Network& network_;
  Forwarding forwarding_;
  const Receiving receiving_;
  bool watches_for_network_;  ///< loopback was chosen, as no other interface was up
  std::uint64_t rounds_ = 0;
};

/// Attaches to isobard, and publishes its absence in the diagnostics until it runs.
class Connector {
 public:
  Connector(Outputs& outputs, const std::string& node_name) : outputs_(outputs), builder_(node_name) {}

  /// Waits kAttachTimeout for isobard.
  /// @return null while isobard does not run
  std::unique_ptr<ipc::Attachment> attach(Service& service) {
    try {
      return std::make_unique<ipc::Attachment>("isobar-dds", kAttachTimeout);
    } catch (const ServiceError& error) {
      if (!logged_) {
        spdlog::info("{}; waiting for it", error.what());
        service.set_status("waiting for isobard");
        logged_ = true;
      }
      report_absence(outputs_, builder_);
      return nullptr;
    }
  }

 private:
  Outputs& outputs_;
  dds::DiagnosticsBuilder builder_;
  bool logged_ = false;
};

int run(const Settings& settings) {
  Service service;  // first, so that every thread inherits the blocked signals
  ipc::set_fatal_action(&replace_process_later);
  Network network(settings);
  const std::string& interface = network.participant.network_interface();
  spdlog::info("DDS domain {} on {}", settings.dds.domain_id, interface.empty() ? "the network" : interface);
  service.ready("DDS is up");
  Connector connector(network.outputs, settings.dds.node_name);
  std::optional<Connection> connection;
  service.supervise([&] {
    if (connection) return connection->check();
    const TimeLimit limit(kAttachLimit, &replace_process);
    if (auto attachment = connector.attach(service)) {
      connection.emplace(std::move(attachment), network, settings);
      service.set_status("forwarding");
      spdlog::info("attached to isobard");
    }
    return true;
  });
  // The library detaches only after main() has returned.
  if (connection) end_process_after(kDetachLimit);
  connection.reset();
  spdlog::info("stopped");
  return 0;
}

}  // namespace
}  // namespace isobar::bridge

int main(int argc, char** argv) {
  isobar::bridge::remember_arguments(argv);
  isobar::set_up_logging("isobar-dds");
  CLI::App app;
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
    spdlog::error("unexpected: {}", error.what());
    return 70;
  }
}
