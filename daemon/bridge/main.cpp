// SPDX-License-Identifier: BSD-3-Clause
// isobar-dds: the bridge between isobard's shared memory and DDS.
//
// A process of its own, so that a fault in a network parser cannot reach the estimator. Waits for isobard and
// for the network without limit. Restarts itself in place when isobard ends, because a process can attach to
// shared memory only once.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "daemon/bridge/forwarding.hpp"
#include "daemon/bridge/network.hpp"
#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/process.hpp"
#include "daemon/bridge/receiving.hpp"
#include "daemon/bridge/repeated_lines.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/steady_time.hpp"
#include "daemon/logging.hpp"
#include "daemon/service.hpp"
#include "ipc/dds/library_log.hpp"
#include "ipc/dds/refused_members.hpp"
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

/// The log of Cyclone DDS, thinned: a lost address or a stranger's datagrams would give a line each.
RepeatedLines g_library_lines;

void log_library_line(bool is_error, std::string_view line) noexcept {
  if (dds::note_refusal(line)) return;
  const auto text = g_library_lines.note(line, steady_ns());
  if (text) spdlog::log(is_error ? spdlog::level::err : spdlog::level::warn, "Cyclone DDS: {}", *text);
}

void log_library_counts() {
  if (const auto line = g_library_lines.due(steady_ns())) spdlog::warn("Cyclone DDS: {}", *line);
}

/// The shared-memory side and both directions of forwarding, from attaching to isobard until the end.
class Connection {
 public:
  Connection(std::unique_ptr<ipc::Attachment> attachment, Network& network, Outputs& outputs,
             const Settings& settings)
      : attachment_(std::move(attachment)),
        network_(network),
        settings_(settings),
        forwarding_(outputs, settings.dds) {
    receive();
  }

  /// Hash of the configuration that isobard has in force; empty: not known yet.
  [[nodiscard]] std::string configuration() const { return forwarding_.configuration(); }

  /// One round of the supervise loop. Restarts the process when the connection has become useless.
  /// @return true when the pose thread has completed a round since the last call
  bool check() {
    if (receiving_) forwarding_.put_received(receiving_->counts());
    forwarding_.put_keys(network_.keys().status());
    if (const auto reason = reason_to_restart()) {
      spdlog::warn("{}; restarting", *reason);
      // No detaching from shared memory: that blocks without isobard, and the restarted program does not need
      // it.
      network_.leave();
      replace_process();
    }
    const std::uint64_t rounds_before = rounds_;
    rounds_ = forwarding_.rounds();
    return rounds_ != rounds_before;
  }

  /// Makes the DDS side anew. Messages of isobard wait meanwhile and are then forwarded: none is lost.
  void renew_network() {
    {
      const auto pause = forwarding_.pause();
      receiving_.reset();
      network_.renew();
      network_.wait_for_readers();
    }
    receive();
  }

 private:
  /// Makes the readers, while there is a network.
  void receive() {
    forwarding_.put_network(network_.state());
    if (!network_.is_up()) return;
    receiving_.emplace(network_.participant(), network_.keys().participant(), settings_, forwarding_.clock());
    network_.announce(receiving_->readers());
  }

  [[nodiscard]] std::optional<std::string> reason_to_restart() const {
    if (!attachment_->broker_alive()) return "isobard has ended";
    if (forwarding_.silence() > kMaxSilence) {
      return "no message from isobard for " + std::to_string(kMaxSilence.count()) + " s";
    }
    return std::nullopt;
  }

  std::unique_ptr<ipc::Attachment> attachment_;
  Network& network_;
  const Settings& settings_;
  Forwarding forwarding_;
  std::optional<Receiving> receiving_;  ///< while there is a network
  std::uint64_t rounds_ = 0;
};

/// Attaches to isobard, and publishes its absence in the diagnostics until it runs.
class Connector {
 public:
  Connector(Outputs& outputs, const std::string& node_name) : outputs_(outputs), builder_(node_name) {}

  /// Waits kAttachTimeout for isobard. Logs what it waits for, at once and then every minute.
  /// @return null while isobard does not run
  std::unique_ptr<ipc::Attachment> attach(Service& service) {
    try {
      return std::make_unique<ipc::Attachment>("isobar-dds", kAttachTimeout);
    } catch (const ServiceError& error) {
      const std::int64_t now_ns = steady_ns();
      if (now_ns >= next_line_ns_) {
        spdlog::info("{}; waiting for it (systemctl status isobard)", error.what());
        service.set_status("waiting for isobard");
        next_line_ns_ = now_ns + kReminderNs;
      }
      report_absence(outputs_, builder_);
      return nullptr;
    }
  }

 private:
  Outputs& outputs_;
  dds::DiagnosticsBuilder builder_;
  std::int64_t next_line_ns_ = 0;
};

/// The supervise loop's work.
class Bridge {
 public:
  Bridge(Service& service, const Options& options, const Settings& settings)
      : service_(service),
        options_(options),
        settings_(settings),
        outputs_(settings),
        network_(settings, outputs_),
        connector_(outputs_, settings.dds.node_name) {
    network_.renew();
  }

  /// @return true when no thread hangs
  bool tick() {
    log_library_counts();
    follow_configuration();
    if (network_.is_due()) renew_network();
    if (connection_) return connection_->check();
    const TimeLimit limit(kAttachLimit, &replace_process);
    if (auto attachment = connector_.attach(service_)) {
      connection_.emplace(std::move(attachment), network_, outputs_, settings_);
      spdlog::info("attached to isobard");
      tell_status();
    }
    return true;
  }

  /// Ends the forwarding. The library detaches only after main() has returned.
  void stop() {
    if (connection_) end_process_after(kDetachLimit);
    connection_.reset();
  }

 private:
  void renew_network() {
    if (connection_) {
      connection_->renew_network();
      tell_status();
    } else {
      network_.renew();
    }
  }
  /// isobard decides which configuration is in force; the bridge follows when it changes, and after SIGHUP.
  void follow_configuration() {
    const bool asked = service_.take_reload_request();
    const std::string configuration = connection_ ? connection_->configuration() : "";
    const bool changed = !configuration.empty() && !configuration_.empty() && configuration != configuration_;
    if (!configuration.empty()) configuration_ = configuration;
    if (!asked && !changed) return;
    service_.reloading();
    try {
      if (load_settings(options_).values != settings_.values) {
        spdlog::info("the settings of DDS have changed; restarting");
        network_.leave();
        replace_process();
      }
    } catch (const Error& error) {
      spdlog::error("configuration refused, the former one stays in force: {}", error.what());
    }
    service_.ready("forwarding; " + network_.state().message);
  }
  void tell_status() { service_.set_status("forwarding; " + network_.state().message); }

  Service& service_;
  const Options& options_;
  const Settings& settings_;
  std::string configuration_;  ///< hash of isobard's configuration in force; empty: not known yet
  Outputs outputs_;
  Network network_;
  Connector connector_;
  std::optional<Connection> connection_;
};

int run(const Options& options) {
  const Settings settings = load_settings(options);
  Service service;  // first, so that every thread inherits the blocked signals
  ipc::set_fatal_action(&replace_process_later);
  dds::set_library_log(&log_library_line);
  Bridge bridge(service, options, settings);
  service.ready("started");
  service.supervise([&] { return bridge.tick(); });
  bridge.stop();
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
    return isobar::bridge::run(options);
  } catch (const isobar::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    spdlog::error("unexpected: {}", error.what());
    return 70;
  }
}
