// SPDX-License-Identifier: BSD-3-Clause
// Participant of this program in a DDS domain.
#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>
#include <vector>

#include "ipc/dds/interfaces.hpp"

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
  std::string network_interface;  ///< names or addresses, separated by commas; empty: all
  int max_message_bytes = 14720;
  std::string peers;  ///< IPv4 addresses, separated by commas
  /// CYCLONEDDS_URI: configuration of Cyclone DDS, which goes before these settings. Empty: none.
  std::string uri;
  bool uri_names_interfaces = false;  ///< then `network_interface` is not used
};

/// A DDS domain and a participant in it that ROS 2 tools recognise. At most one per process and domain.
class Participant {
 public:
  /// On the interfaces that are up now; an interface asked for that is not up is left out.
  /// @throws ServiceError when no interface is up, when the domain has no free port, or when DDS fails
  ///         otherwise
  explicit Participant(const ParticipantSettings& settings);
  Participant(const ParticipantSettings& settings, const InterfaceChoice& choice);

  [[nodiscard]] dds_entity_t get() const noexcept { return participant_.get(); }
  /// Not those that CYCLONEDDS_URI names.
  [[nodiscard]] const InterfaceChoice& interfaces() const noexcept { return interfaces_; }

 private:
  InterfaceChoice interfaces_;
  Entity domain_;
  Entity participant_;
};

/// XML configuration for Cyclone DDS.
[[nodiscard]] std::string domain_configuration(const ParticipantSettings& settings,
                                               const std::vector<Interface>& interfaces);

}  // namespace isobar::dds
