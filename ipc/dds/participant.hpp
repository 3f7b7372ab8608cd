// SPDX-License-Identifier: BSD-3-Clause
// The program's presence in a DDS domain.
#pragma once

#include <dds/dds.h>

#include <string>
#include <utility>

namespace isobar::dds {

/// Owns a Cyclone DDS entity and all that was made from it.
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

/// Owns the result of a Cyclone DDS call.
/// @throws ServiceError the call failed; says `what` and why
[[nodiscard]] Entity checked(dds_entity_t handle, const std::string& what);

/// What a participant is configured by.
struct ParticipantSettings {
  int domain_id = 0;
  std::string network_interface;  ///< empty: chosen
  int max_message_bytes = 14720;
};

/// A domain and a participant in it that ROS 2 tools take for one of theirs. One a process and domain.
class Participant {
 public:
  /// @throws ServiceError no such network interface, no ports left, or DDS refuses
  explicit Participant(const ParticipantSettings& settings);

  [[nodiscard]] dds_entity_t get() const noexcept { return participant_.get(); }
  /// The interface that was asked for or chosen; empty: left to Cyclone DDS.
  [[nodiscard]] const std::string& network_interface() const noexcept { return network_interface_; }

 private:
  std::string network_interface_;
  Entity domain_;
  Entity participant_;
};

/// "lo" where the machine has no other IPv4 network that is up, else empty.
[[nodiscard]] std::string loopback_if_alone();

/// Cyclone DDS's configuration, as it reads it.
[[nodiscard]] std::string domain_configuration(const ParticipantSettings& settings);

}  // namespace isobar::dds
