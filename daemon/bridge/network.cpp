// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/network.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

#include "core/errors.hpp"
#include "core/text_list.hpp"
#include "daemon/bridge/steady_time.hpp"

namespace isobar::bridge {
namespace {

/// Time between two looks at the interfaces [ns]. A change has to be seen twice: an address that is set
/// anew at once, as DHCP clients do, is none.
constexpr std::int64_t kLookPeriodNs = 500'000'000;
/// Time between two attempts to create the participant [ns].
constexpr std::int64_t kRetryNs = 1'000'000'000;
/// Longest wait for readers [ms]: discovery on loopback takes 10 ms.
constexpr int kMostReaderWaitMs = 100;

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

dds::ParticipantSettings participant_settings(const Settings& settings) {
  dds::ParticipantSettings result;
  result.domain_id = settings.dds.domain_id;
  result.network_interface = settings.dds.network_interface;
  result.max_message_bytes = settings.dds.max_message_bytes;
  result.peers = settings.dds.peers;
  result.uri = settings.environment.uri;
  result.uri_names_interfaces = settings.environment.uri_names_interfaces;
  return result;
}

}  // namespace

Network::Network(const Settings& settings, Outputs& outputs)
    : settings_(settings),
      outputs_(outputs),
      participant_settings_(participant_settings(settings)),
      keys_(settings) {
  for (const std::string& note : settings.environment.notes) spdlog::info("{}", note);
}

Network::~Network() { close(); }

dds::InterfaceChoice Network::choose() const {
  return dds::choose_interfaces(dds::interfaces_up(), split_list(participant_settings_.network_interface));
}

bool Network::is_due() {
  const std::int64_t now_ns = steady_ns();
  if (now_ns < next_look_ns_) return false;
  next_look_ns_ = now_ns + kLookPeriodNs;
  dds::InterfaceChoice choice = choose();
  const bool is_stable = choice == last_seen_;
  const bool has_changed = is_stable && !(choice == chosen_);
  last_seen_ = std::move(choice);
  remind(now_ns);
  return has_changed || (participant_ && keys_.is_due()) || (!participant_ && now_ns >= next_attempt_ns_);
}

void Network::renew() {
  readers_before_ = reader_count();
  close();
  open();
}

void Network::change(const std::function<void()>& change_settings) {
  readers_before_ = reader_count();
  close();
  change_settings();
  participant_settings_ = participant_settings(settings_);
  keys_ = StationKeys(settings_);
  outputs_.configure(settings_);
  open();
}

void Network::open() {
  const std::int64_t now_ns = steady_ns();
  next_attempt_ns_ = now_ns + kRetryNs;
  chosen_ = last_seen_ = choose();
  failure_.clear();
  try {
    if (chosen_.used.empty() && !participant_settings_.uri_names_interfaces) {
      throw ServiceError("no network interface is up, not even loopback (ip link set lo up)");
    }
    participant_.emplace(participant_settings_, chosen_);
    keys_.open(participant_settings_, chosen_.used, participant_->get());
    outputs_.open(participant_->get(), keys_.participant());
    announcement_.emplace(participant_->get(), settings_.dds.ros_gid_bytes);
    announce({});
  } catch (const ServiceError& error) {
    close();
    failure_ = error.what();
  }
  log_interfaces();
  remind(now_ns);
}

void Network::close() noexcept {
  announcement_.reset();
  outputs_.close();
  keys_.close();
  participant_.reset();
}

void Network::leave() noexcept {
  keys_.leave();
  if (participant_) dds_delete(participant_->get());
}

std::uint64_t Network::reader_count() const {
  std::uint64_t count = 0;
  for (const dds_entity_t writer : outputs_.writers()) count += dds::readers_of(writer);
  return count;
}

void Network::wait_for_readers() const {
  for (int ms = 0; ms < kMostReaderWaitMs && is_up() && reader_count() < readers_before_; ++ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void Network::announce(const std::vector<dds_entity_t>& readers) {
  announcement_->announce(settings_.dds.ros_namespace, settings_.dds.node_name, outputs_.writers(), readers);
}

std::string Network::waits_for() const {
  if (!failure_.empty()) return failure_ + "; trying again every second";
  if (chosen_.missing.empty() || participant_settings_.uri_names_interfaces) return {};
  const std::string names = joined_names(chosen_.missing);
  return "dds.network_interface: " + names +
         " is not up or has no IPv4 address (ip address show); waiting for " +
         (chosen_.missing.size() == 1 ? "it" : "them");
}

void Network::remind(std::int64_t now_ns) {
  const std::string waits = waits_for();
  if (waits.empty()) {
    next_reminder_ns_ = 0;
  } else if (now_ns >= next_reminder_ns_) {
    next_reminder_ns_ = now_ns + kReminderNs;
    spdlog::warn("{}", waits);
  }
}

void Network::log_interfaces() {
  if (!participant_) return;
  const std::string domain = "DDS domain " + std::to_string(settings_.dds.domain_id);
  const std::string line =
      domain + " on " +
      (participant_settings_.uri_names_interfaces ? "the interfaces of CYCLONEDDS_URI"
                                                  : dds::text_of(chosen_.used)) +
      (chosen_.used.size() == 1 && chosen_.used[0].is_loopback ? ": this machine only" : "");
  if (line == logged_) return;
  logged_ = line;
  spdlog::info("{}", line);
  if (!chosen_.left_out.empty()) {
    spdlog::warn("DDS uses {} interfaces at most and leaves out {}; choose with dds.network_interface",
                 dds::InterfaceChoice::kMost, joined_names(chosen_.left_out));
  }
}

NetworkState Network::state() const {
  const std::string waits = waits_for();
  if (!waits.empty()) return {ipc::HealthLevel::kWarning, waits};
  return {ipc::HealthLevel::kOk, logged_};
}

}  // namespace isobar::bridge
