// SPDX-License-Identifier: BSD-3-Clause
// Network interfaces of this machine, and which of them DDS uses.
#pragma once

#include <string>
#include <vector>

namespace isobar::dds {

/// An IPv4 address of a network interface that is up.
struct Interface {
  std::string name;     ///< "wlan0"
  std::string address;  ///< "192.168.1.7"
  unsigned index = 0;   ///< the kernel's number: another one after an adapter was plugged out and in again
  bool is_loopback = false;
  bool has_multicast = false;
  bool is_device = false;  ///< hardware; false: virtual, such as a container's bridge

  bool operator==(const Interface&) const = default;
};

/// All of them, in the kernel's order. Empty when the kernel does not tell.
[[nodiscard]] std::vector<Interface> interfaces_up();

/// The interfaces that DDS uses.
struct InterfaceChoice {
  /// Cyclone DDS's limit.
  static constexpr std::size_t kMost = 4;

  std::vector<Interface> used;        ///< loopback first: subscribers of this machine depend on no network
  std::vector<std::string> missing;   ///< asked for, but not up or without an IPv4 address
  std::vector<std::string> left_out;  ///< beyond kMost

  bool operator==(const InterfaceChoice&) const = default;
};

/// @param wanted names or addresses; loopback is used beside them. Empty: all interfaces, one address of each,
///        hardware before virtual ones.
[[nodiscard]] InterfaceChoice choose_interfaces(const std::vector<Interface>& up,
                                                const std::vector<std::string>& wanted);

/// "lo (127.0.0.1), wlan0 (192.168.1.7)"
[[nodiscard]] std::string text_of(const std::vector<Interface>& interfaces);

}  // namespace isobar::dds
