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
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "config/problems.hpp"
#include "core/errors.hpp"
#include "daemon/bridge/connection.hpp"
#include "daemon/bridge/network.hpp"
#include "daemon/bridge/process.hpp"
#include "daemon/bridge/repeated_lines.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/settings_source.hpp"
#include "daemon/bridge/steady_time.hpp"
#include "daemon/logging.hpp"
#include "daemon/service.hpp"
#include "ipc/dds/library_log.hpp"
#include "ipc/dds/refused_members.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest wait for isobard in a start with bad files.
constexpr auto kFirstAttachTimeout = 3s;
/// Time limit for attaching: milliseconds, but it blocks for ever when isobard ends in the middle of it.
constexpr auto kAttachLimit = 10s;
/// Time limit for a stop, which takes some 0.1 s: detaching blocks for ever when isobard hangs, and leaving the network
/// waits for readers that do not acknowledge.
constexpr auto kStopLimit = 800ms;

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

/// The supervise loop's work.
class Bridge {
 public:
  Bridge(Service& service, SettingsSource& source, std::unique_ptr<ipc::Attachment> attachment)
      : service_(service),
        source_(source),
        settings_(source.settings()),
        outputs_(settings_),
        network_(settings_, outputs_),
        connector_(outputs_, settings_.dds.node_name, std::move(attachment)) {
    network_.renew();
  }

  /// @return true when no thread hangs
  bool tick() {
    log_library_counts();
    follow_settings();
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
  void stop() { connection_.reset(); }

 private:
  void renew_network() {
    if (connection_) {
      connection_->renew_network();
      tell_status();
    } else {
      network_.renew();
    }
  }
  /// isobard decides which settings are in force; without it, SIGHUP reads the files.
  void follow_settings() {
    bool changed = false;
    if (connection_) {
      if (const auto isobard = connection_->description()) changed = source_.follow(*isobard);
    }
    const bool asked = service_.take_reload_request();
    if (asked) service_.reloading();
    if (asked) changed = source_.reload() || changed;
    if (changed) change_settings();
    if (asked) service_.ready(status());
  }
  void change_settings() {
    const auto change = [this] { settings_ = source_.settings(); };
    if (connection_) {
      connection_->change_settings(source_.settings(), change);
      tell_status();
    } else {
      network_.change(change);
    }
    connector_.set_node_name(settings_.dds.node_name);
  }
  [[nodiscard]] std::string status() const {
    return (connection_ ? "forwarding; " : "waiting for isobard; ") + network_.state().message;
  }
  void tell_status() { service_.set_status(status()); }

  Service& service_;
  SettingsSource& source_;
  Settings settings_;  ///< to which the others refer
  Outputs outputs_;
  Network network_;
  Connector connector_;
  std::optional<Connection> connection_;
};

/// A start with bad files of which nothing is kept: the settings of an isobard that runs.
/// @return null when none runs, or when it runs with other files
std::unique_ptr<SettingsSource> settings_of_isobard(const Options& options,
                                                    std::unique_ptr<ipc::Attachment>& attachment) {
  try {
    const TimeLimit limit(kAttachLimit, &replace_process);
    attachment = std::make_unique<ipc::Attachment>(kProgram, kFirstAttachTimeout);
    ipc::Subscriber<ipc::RunDescription> descriptions(ipc::topics::kRunDescription);
    ipc::Waiter waiter({&descriptions.raw()});
    static_cast<void>(waiter.wait_for(1s));
    const auto isobard = descriptions.take_latest();
    return isobard ? std::make_unique<SettingsSource>(options, *isobard) : nullptr;
  } catch (const Error& error) {
    spdlog::warn("no settings of isobard either: {}", error.what());
    return nullptr;
  }
}

std::unique_ptr<SettingsSource> first_source(const Options& options,
                                             std::unique_ptr<ipc::Attachment>& attachment) {
  try {
    return std::make_unique<SettingsSource>(options);
  } catch (const ConfigErrors& errors) {
    auto source = settings_of_isobard(options, attachment);
    if (!source) throw;
    for (const std::string& problem : errors.all()) spdlog::error("configuration refused: {}", problem);
    spdlog::warn("the settings that isobard has in force are used");
    return source;
  }
}

int run(const Options& options) {
  Service service;  // first, so that every thread inherits the blocked signals
  limit_stop(service, kStopLimit);
  ipc::set_fatal_action(&replace_process_later);
  std::unique_ptr<ipc::Attachment> attachment;
  const auto source = first_source(options, attachment);
  dds::set_library_log(&log_library_line);
  Bridge bridge(service, *source, std::move(attachment));
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
  } catch (const isobar::ConfigErrors& errors) {
    for (const std::string& problem : errors.all()) spdlog::error("{}", problem);
    return errors.exit_code();
  } catch (const isobar::Error& error) {
    spdlog::error("{}", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    spdlog::error("unexpected: {}", error.what());
    return 70;
  }
}
