// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/connection.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "core/errors.hpp"
#include "daemon/bridge/process.hpp"
#include "daemon/bridge/steady_time.hpp"

namespace isobar::bridge {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest silence of a running isobard: it sends hundreds of priors a second and its health once a
/// second. After a longer one this process is no longer connected, for instance because iceoryx
/// unregistered it while it was stopped.
constexpr auto kMaxSilence = 5s;
/// Time limit for ending the threads and for leaving the network before a restart, which take milliseconds: they can
/// block when isobard was killed in the middle of an exchange.
constexpr auto kRestartLimit = 500ms;
/// Longest wait for isobard in one round of the supervise loop; stop signals are seen between two rounds.
constexpr auto kAttachTimeout = 400ms;

}  // namespace

Connection::Connection(std::unique_ptr<ipc::Attachment> attachment, Network& network, Outputs& outputs,
                       const Settings& settings)
    : attachment_(std::move(attachment)),
      network_(network),
      settings_(settings),
      forwarding_(outputs, settings.dds) {
  receive();
}

bool Connection::check() {
  if (receiving_) {
    forwarding_.put_received(receiving_->counts());
    forwarding_.put_inputs(receiving_->states());
    if (forwarding_.floor_writer_count() != announced_floor_writers_) announce();
  }
  forwarding_.put_keys(network_.keys().status());
  if (const auto reason = reason_to_restart()) {
    spdlog::warn("{}; restarting", *reason);
    restart();
  }
  const std::uint64_t rounds_before = rounds_;
  rounds_ = forwarding_.rounds();
  return rounds_ != rounds_before;
}

// Shared memory first: an isobard that ends waits until nobody uses it. The rest of the library's detaching, after
// main(), is left out: it blocks without isobard, and the restarted program does not need it.
void Connection::restart() {
  const TimeLimit limit(kRestartLimit, &replace_process);
  receiving_.reset();
  forwarding_.stop();
  attachment_.reset();
  network_.leave();
  replace_process();
}

void Connection::renew_network() {
  {
    const auto pause = forwarding_.pause();
    receiving_.reset();
    network_.renew();
    network_.wait_for_readers();
  }
  receive();
}

void Connection::change_settings(const Settings& next, const std::function<void()>& change) {
  forwarding_.set_clouds(forwarding_.has_clouds() && publishes_clouds(next));
  if (next.is_base_station) forwarding_.set_floors(false);
  {
    const auto pause = forwarding_.pause();
    receiving_.reset();
    network_.change(change);
    forwarding_.configure(settings_.dds);
    network_.wait_for_readers();
  }
  forwarding_.set_clouds(publishes_clouds(settings_));
  forwarding_.set_floors(!settings_.is_base_station);
  receive();
}

// Makes the readers, while there is a network.
void Connection::receive() {
  forwarding_.put_network(network_.state());
  if (!network_.is_up()) return;
  receiving_.emplace(network_.participant(), network_.keys().participant(), settings_, forwarding_.clock());
  announce();
}

// Under the lock of the thread that makes writers.
void Connection::announce() {
  const auto pause = forwarding_.pause_floors();
  announced_floor_writers_ = forwarding_.floor_writer_count();
  network_.announce(receiving_->readers());
}

std::optional<std::string> Connection::reason_to_restart() const {
  if (!attachment_->broker_alive()) return "isobard has ended";
  if (forwarding_.silence() > kMaxSilence) {
    return "no message from isobard for " + std::to_string(kMaxSilence.count()) + " s";
  }
  return std::nullopt;
}

std::unique_ptr<ipc::Attachment> Connector::attach(Service& service) {
  if (early_) return std::move(early_);
  try {
    return std::make_unique<ipc::Attachment>(kProgram, kAttachTimeout);
  } catch (const ServiceError& error) {
    const std::int64_t now_ns = steady_ns();
    if (now_ns >= next_line_ns_) {
      spdlog::info("{}; waiting for it (systemctl status isobard)", error.what());
      service.set_status("waiting for isobard");
      next_line_ns_ = now_ns + kReminderNs;
    }
    report_absence(outputs_, *builder_);
    return nullptr;
  }
}

}  // namespace isobar::bridge
