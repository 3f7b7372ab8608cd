// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>

namespace isobar::dds {
namespace {

std::string address_of(const ifaddrs& entry) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const auto* address = reinterpret_cast<const sockaddr_in*>(entry.ifa_addr);  // NOLINT: as sa_family says
  return inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr ? text.data() : "";
}

/// The name of an interface; an alias, "eth0:1", bears that of its interface.
std::string name_of(const ifaddrs& entry) {
  const std::string name = entry.ifa_name;
  return name.substr(0, name.find(':'));
}

bool is_link_local(const Interface& interface) { return interface.address.starts_with("169.254."); }

/// How much an interface promises: a network of several machines before anything else.
int rank_of(const Interface& interface) {
  return (interface.is_device ? 4 : 0) + (interface.has_multicast ? 2 : 0) +
         (is_link_local(interface) ? 0 : 1);
}

/// One address of each interface but loopback, best first.
std::vector<Interface> one_of_each(std::vector<Interface> up) {
  std::stable_sort(up.begin(), up.end(),
                   [](const Interface& a, const Interface& b) { return rank_of(a) > rank_of(b); });
  std::vector<Interface> result;
  for (const Interface& candidate : up) {
    const bool known = std::any_of(result.begin(), result.end(),
                                   [&](const Interface& other) { return other.name == candidate.name; });
    if (!known && !candidate.is_loopback) result.push_back(candidate);
  }
  return result;
}

}  // namespace

std::vector<Interface> interfaces_up() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  std::vector<Interface> interfaces;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    constexpr unsigned kUp = IFF_UP | IFF_RUNNING;
    if ((entry->ifa_flags & kUp) != kUp || entry->ifa_addr == nullptr ||
        entry->ifa_addr->sa_family != AF_INET) {
      continue;
    }
    Interface interface;
    interface.name = name_of(*entry);
    interface.address = address_of(*entry);
    interface.index = ::if_nametoindex(interface.name.c_str());
    interface.is_loopback = (entry->ifa_flags & IFF_LOOPBACK) != 0;
    interface.has_multicast = (entry->ifa_flags & IFF_MULTICAST) != 0;
    interface.is_device = ::access(("/sys/class/net/" + interface.name + "/device").c_str(), F_OK) == 0;
    interfaces.push_back(std::move(interface));
  }
  return interfaces;
}

InterfaceChoice choose_interfaces(const std::vector<Interface>& up, const std::vector<std::string>& wanted) {
  InterfaceChoice choice;
  const auto loopback =
      std::find_if(up.begin(), up.end(), [](const Interface& interface) { return interface.is_loopback; });
  if (loopback != up.end()) choice.used.push_back(*loopback);
  const auto use = [&choice](const Interface& interface) {
    if (interface.is_loopback ||
        std::find(choice.used.begin(), choice.used.end(), interface) != choice.used.end()) {
      return;
    }
    if (choice.used.size() < InterfaceChoice::kMost) {
      choice.used.push_back(interface);
    } else {
      choice.left_out.push_back(interface.name);
    }
  };
  if (wanted.empty()) {
    for (const Interface& interface : one_of_each(up)) use(interface);
    return choice;
  }
  for (const std::string& name : wanted) {
    const auto found = std::find_if(up.begin(), up.end(), [&](const Interface& interface) {
      return interface.name == name || interface.address == name;
    });
    if (found == up.end()) {
      choice.missing.push_back(name);
    } else {
      use(*found);
    }
  }
  return choice;
}

std::string text_of(const std::vector<Interface>& interfaces) {
  std::string text;
  for (const Interface& interface : interfaces) {
    text += (text.empty() ? "" : ", ") + interface.name + " (" + interface.address + ")";
  }
  return text;
}

}  // namespace isobar::dds
