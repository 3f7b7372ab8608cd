// SPDX-License-Identifier: BSD-3-Clause
// A participant that only members with keys of the same authorities can talk to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/dds/participant.hpp"

namespace isobar::dds {

/// A second participant of this process in the same DDS domain, with authentication and signatures.
///
/// It has a domain object of its own inside Cyclone DDS, which in the network has the number of the plain
/// participant's domain: Cyclone 0.10.2 crashes when participants with and without security share one. So
/// the plain topics stay as they are without keys, and faults of the keys never reach them.
class SecureParticipant {
 public:
  /// @param settings, interfaces of the plain participant; domain_id at most keys::kLastDomain
  /// @param keys folder that keys::check_key_folder() accepts
  /// @throws ServiceError when the security plugins are not installed or refuse the keys, or when DDS fails
  SecureParticipant(const ParticipantSettings& settings, const std::vector<Interface>& interfaces,
                    const std::filesystem::path& keys);
  /// On the interfaces that are up now.
  SecureParticipant(const ParticipantSettings& settings, const std::filesystem::path& keys);

  [[nodiscard]] dds_entity_t get() const noexcept { return participant_.get(); }

 private:
  Entity domain_;
  Entity participant_;
};

/// Number inside this process of the secure domain object: another one than the plain domain's.
[[nodiscard]] int secure_domain_number(int domain_id);

/// XML configuration of the secure domain object.
[[nodiscard]] std::string secure_domain_configuration(const ParticipantSettings& settings,
                                                      const std::vector<Interface>& interfaces);

}  // namespace isobar::dds
