// SPDX-License-Identifier: BSD-3-Clause
// Participant of this program in a DDS domain.
#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>

namespace isobar::dds {

/// Owner of a Cyclone DDS entity and its child entities.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  ~Entity() { reset(); }
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    if (this != &other) {
      reset();
      handle_ = std::exchange(other.handle_, 0);
    }
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  [[nodiscard]] dds_entity_t get() const noexcept { return handle_; }
  void reset() noexcept {
    if (handle_ > 0) {
      dds_delete(std::exchange(handle_, 0));
    }
  }

 private:
  dds_entity_t handle_ = 0;
};

/// Takes ownership of the entity that a Cyclone DDS call returned.
/// @param what the entity, for the error's text
/// @throws ServiceError when the call failed, with its reason
[[nodiscard]] Entity checked(dds_entity_t handle, const std::string& what);

/// Network settings of a participant, see DdsConfig.
struct ParticipantSettings {
  int domain_id = 0;
  std::string network_interface;  ///< name or address; empty: chosen automatically
  int max_message_bytes = 14720;
};

/// A DDS domain and a participant in it that ROS 2 tools recognise. At most one per process and domain.
class Participant {
 public:
  /// @throws ServiceError when the network interface does not exist, when the domain has no free port, or
  ///         when DDS fails otherwise
  explicit Participant(const ParticipantSettings& settings);

  [[nodiscard]] dds_entity_t get() const noexcept { return participant_.get(); }
  /// The configured interface, or "lo" where it was chosen; empty: chosen by Cyclone DDS.
  [[nodiscard]] const std::string& network_interface() const noexcept { return network_interface_; }

 private:
  std::string network_interface_;
  Entity domain_;
  Entity participant_;
};

/// "lo" when loopback is the only IPv4 interface that is up, else empty.
[[nodiscard]] std::string loopback_if_alone();

/// XML configuration for Cyclone DDS.
[[nodiscard]] std::string domain_configuration(const ParticipantSettings& settings);

}  // namespace isobar::dds
