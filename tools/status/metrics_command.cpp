// SPDX-License-Identifier: BSD-3-Clause
// `isobar metrics`: the health of isobard for Prometheus. A process of its own, so that no HTTP request ever
// reaches the estimator.
#include <prometheus/exposer.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "core/errors.hpp"
#include "daemon/logging.hpp"
#include "daemon/service.hpp"
#include "ipc/service_view.hpp"
#include "tools/commands.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/status/health_reader.hpp"
#include "tools/status/metrics.hpp"

namespace isobar::tools {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// The HTTP server, once the address can be listened on.
class Endpoint {
 public:
  Endpoint(std::string address, const std::shared_ptr<MetricsSource>& source)
      : address_(std::move(address)), source_(source) {}

  /// Tries to listen, if it does not yet; says once why it cannot.
  void open() {
    if (exposer_) return;
    try {
      exposer_.emplace(address_);
      exposer_->RegisterCollectable(source_);
      log_info("metrics on http://" + address_ + "/metrics");
    } catch (const std::exception&) {
      exposer_.reset();
      if (!said_) {
        log_warning(address_ +
                    ": cannot be listened on; the address does not exist or another program uses "
                    "the port; trying again every second");
      }
      said_ = true;
    }
  }

 private:
  std::string address_;
  std::shared_ptr<MetricsSource> source_;
  std::optional<prometheus::Exposer> exposer_;
  bool said_ = false;
};

/// Attaches to isobard.
/// @return null while it does not run
std::unique_ptr<HealthReader> attach(bool& said) {
  try {
    auto reader = std::make_unique<HealthReader>("isobar-metrics", 0ms, HangLimit::kWait);
    log_info("attached to isobard");
    return reader;
  } catch (const ServiceError& error) {
    if (!said) log_info(std::string(error.what()) + "; waiting for it");
    said = true;
    return nullptr;
  }
}

void run_metrics(const std::string& address) {
  set_up_logging("isobar-metrics");
  ipc::enter_service_view();
  Service service;  // first, so that every thread inherits the blocked signals
  const auto source = std::make_shared<MetricsSource>();
  std::optional<Endpoint> endpoint(std::in_place, address, source);
  std::unique_ptr<HealthReader> reader;
  bool said = false;
  endpoint->open();
  service.ready("metrics on " + address);
  while (service.wait_for(reader ? 100ms : 1s)) {
    endpoint->open();
    if (!reader) reader = attach(said);
    if (!reader) continue;
    ipc::HealthReport report;
    if (reader->next(report, 400ms)) source->put(report);
    if (!reader->alive()) {
      log_warning("isobard has ended; restarting, to attach to the next one");
      endpoint.reset();  // frees the port
      run_again();
    }
    service.feed_watchdog();
  }
  endpoint.reset();
  end_attached(0);
}

}  // namespace

void add_metrics_command(CLI::App& app) {
  auto address = std::make_shared<std::string>("127.0.0.1:9464");
  CLI::App* command = app.add_subcommand(
      "metrics", "Serve the health of the running isobard to Prometheus, at /metrics, until a signal comes");
  command
      ->add_option(
          "--listen", *address,
          "ADDRESS:PORT; anybody who reaches it may read, so keep it on loopback or behind a firewall")
      ->check([](const std::string& text) {
        const std::size_t colon = text.rfind(':');
        const bool well = colon != std::string::npos && colon > 0 && colon + 1 < text.size() &&
                          text.find_first_not_of("0123456789", colon + 1) == std::string::npos &&
                          text.size() - colon <= 6 && std::stoul(text.substr(colon + 1)) <= 65'535 &&
                          text.find(',') == std::string::npos;
        return well ? std::string() : text + ": must be ADDRESS:PORT, such as 127.0.0.1:9464";
      })
      ->capture_default_str();
  command->callback([address] { run_metrics(*address); });
}

}  // namespace isobar::tools
