// SPDX-License-Identifier: BSD-3-Clause
// The DDS side of the bridge, which follows the network interfaces of the machine.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/station_keys.hpp"
#include "ipc/dds/discovery.hpp"
#include "ipc/dds/participant.hpp"
#include "ipc/topics.hpp"

namespace isobar::bridge {

/// State of the network, for diagnostics and `systemctl status`.
struct NetworkState {
  ipc::HealthLevel level = ipc::HealthLevel::kOk;
  std::string message;
};

/// Participant, writers and node announcement. Cyclone DDS looks at the interfaces only when a domain is
/// created: after a change of addresses or interfaces all of it is made anew, within 0.2 s. Loopback is always
/// among the interfaces, so that subscribers of this machine depend on no network. Main thread.
class Network {
 public:
  /// `outputs` are opened and closed with the participant. Both must outlive the object.
  Network(const Settings& settings, Outputs& outputs);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// Looks at the interfaces, twice a second, and at the keys. Logs what is waited for, at once and then every
  /// minute.
  /// @return true when renew() is due: interfaces or keys have changed, or DDS is down
  bool is_due();
  /// Closes the outputs, makes the participant anew and opens them again. Logs the interfaces, or why there
  /// are none; then is_up() is false, and another attempt is due a second later. Entities of others in the
  /// participant must be gone.
  void renew();
  /// renew() with other settings.
  /// @param change_settings changes the settings that the constructor was given, while all is closed
  void change(const std::function<void()>& change_settings);
  /// Waits until as many readers are matched as before renew(), up to 0.1 s: what is sent earlier is lost to
  /// them. The last participant's remote readers may never come back.
  void wait_for_readers() const;

  [[nodiscard]] bool is_up() const noexcept { return participant_.has_value(); }
  /// Requires is_up().
  [[nodiscard]] dds_entity_t participant() const noexcept { return participant_->get(); }
  /// Publishes that the writers and these readers belong to this ROS 2 node. Requires is_up().
  /// @throws ServiceError when the message cannot be written
  void announce(const std::vector<dds_entity_t>& readers);
  [[nodiscard]] NetworkState state() const;
  [[nodiscard]] StationKeys& keys() noexcept { return keys_; }

  /// Tells the other participants that this one ends, without waiting.
  void leave() noexcept;

 private:
  void open();
  void close() noexcept;
  [[nodiscard]] std::uint64_t reader_count() const;
  [[nodiscard]] dds::InterfaceChoice choose() const;
  /// What is waited for, with the remedy; empty: nothing.
  [[nodiscard]] std::string waits_for() const;
  void remind(std::int64_t now_ns);
  void log_interfaces();

  const Settings& settings_;
  Outputs& outputs_;
  dds::ParticipantSettings participant_settings_;
  dds::InterfaceChoice chosen_;     ///< of the last renew()
  dds::InterfaceChoice last_seen_;  ///< of the last look
  std::optional<dds::Participant> participant_;
  StationKeys keys_;  ///< opened and closed with the participant
  std::optional<dds::NodeAnnouncement> announcement_;
  std::string failure_;  ///< of the last renew(); empty: none
  std::string logged_;   ///< last line about the interfaces
  std::uint64_t readers_before_ = 0;
  std::int64_t next_look_ns_ = 0;     ///< steady clock
  std::int64_t next_attempt_ns_ = 0;  ///< steady clock
  std::int64_t next_reminder_ns_ = 0;
};

}  // namespace isobar::bridge
