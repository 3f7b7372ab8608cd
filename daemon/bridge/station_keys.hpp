// SPDX-License-Identifier: BSD-3-Clause
// Signed base-station pressure: the keys of this machine in the bridge.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "daemon/bridge/settings.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/refused_members.hpp"
#include "ipc/dds/secure_participant.hpp"
#include "ipc/topics.hpp"

namespace isobar::bridge {

/// Status of the keys, for the diagnostics: plain values, trivially copyable.
struct KeyStatus {
  ipc::HealthLevel level = ipc::HealthLevel::kOk;
  std::array<char, 240> text{};      ///< one sentence; null-terminated; empty: not known yet
  double days_left = 0.0;            ///< of the keys' validity; 0 without usable keys
  bool signs = false;                ///< dds.keys_directory is set
  std::uint32_t unsigned_now = 0;    ///< present senders of base-station pressure without keys
  std::uint64_t unsigned_total = 0;  ///< the same, all since the start
  dds::RefusedMembers refused;       ///< participants with keys of other authorities
  bool refused_lately = false;       ///< within the last 10 s
};

/// The keys that dds.keys_directory names, and the participant that has them. Without usable keys there is no
/// participant, and base-station pressure is neither sent nor received: never silently unsigned. One thread.
class StationKeys {
 public:
  explicit StationKeys(const Settings& settings);

  /// Reads the keys and makes the participant. Faults of the keys are logged and in status(); is_due() tells
  /// when they may be gone.
  /// @param network, interfaces, plain of the participant without keys, which sees who sends unsigned pressure
  /// @throws ServiceError when a DDS entity of the plain participant cannot be created
  void open(const dds::ParticipantSettings& network, const std::vector<dds::Interface>& interfaces,
            dds_entity_t plain);
  void close() noexcept;

  /// The participant of the base-station topics: the plain one without dds.keys_directory; 0: none, the keys
  /// cannot be used.
  [[nodiscard]] dds_entity_t participant() const noexcept;
  /// Tells the other members that this participant ends.
  void leave() noexcept;

  /// True when the participant is to be made anew: the keys have become usable, were replaced, or have expired.
  /// Looks at the files every 2 s.
  [[nodiscard]] bool is_due();

  [[nodiscard]] KeyStatus status();

 private:
  using Clock = std::chrono::steady_clock;

  /// The rule that the keys break; empty: none, then it sets until_s_.
  [[nodiscard]] std::string fault_of_keys();
  void make_participant(const dds::ParticipantSettings& network,
                        const std::vector<dds::Interface>& interfaces);
  void add_unsigned(KeyStatus& status) const;
  void note_fault(std::string fault);

  dds::DdsConfig config_;
  std::filesystem::path folder_;     ///< empty: no keys wanted
  std::vector<std::string> heard_;   ///< base stations that a robot listens to
  std::vector<std::string> writes_;  ///< DDS topics
  std::vector<std::string> reads_;
  dds_entity_t plain_ = 0;
  std::string fault_;
  bool refused_by_library_ = false;  ///< fault_ is the library's, not one that fault_of_keys() finds
  std::int64_t until_s_ = 0;
  std::string fingerprint_;
  Clock::time_point next_look_;
  std::uint64_t refused_before_ = 0;
  Clock::time_point last_refusal_;
  std::string logged_;
  std::unique_ptr<dds::SecureParticipant> secure_;
  std::vector<std::unique_ptr<dds::Reader<dds::PressureMessage>>> unsigned_;
};

}  // namespace isobar::bridge
