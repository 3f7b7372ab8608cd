// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/participant.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <memory>
#include <string_view>

#include "core/errors.hpp"
#include "ipc/dds/qos.hpp"

namespace isobar::dds {
namespace {

/// Linux's loopback carries multicast although its interface flags lack IFF_MULTICAST, so the configuration
/// has to enable it. Peers without that setting are reached by unicast.
constexpr std::string_view kLoopback = "lo";

ParticipantSettings with_interface(ParticipantSettings settings) {
  if (settings.network_interface.empty()) {
    settings.network_interface = loopback_if_alone();
  }
  return settings;
}

/// User data of a participant as ROS 2's rmw sets it; ROS 2 tools ignore participants without it.
constexpr std::string_view kUserData = "enclave=/;";

}  // namespace

Entity checked(dds_entity_t handle, const std::string& what) {
  if (handle < 0) {
    throw ServiceError("DDS: " + what + ": " + dds_strretcode(-handle));
  }
  return Entity(handle);
}

std::string loopback_if_alone() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) {
    return {};
  }
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  bool has_loopback = false;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    const bool is_up = (entry->ifa_flags & IFF_UP) != 0;
    if (!is_up || entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) {
      continue;
    }
    if ((entry->ifa_flags & IFF_LOOPBACK) == 0) {
      return {};
    }
    has_loopback = has_loopback || std::string_view(entry->ifa_name) == kLoopback;
  }
  return has_loopback ? std::string(kLoopback) : std::string();
}

std::string domain_configuration(const ParticipantSettings& settings) {
  const std::string& interface = settings.network_interface;
  const bool on_loopback = interface == kLoopback || interface == "127.0.0.1";
  std::string xml = "<Domain Id=\"any\"><General><Interfaces><NetworkInterface ";
  if (interface.empty()) {
    xml += "autodetermine=\"true\"";
  } else {
    const bool is_address = interface.find_first_not_of("0123456789.") == std::string::npos;
    xml += (is_address ? "address=\"" : "name=\"") + interface + "\"";
    xml += on_loopback ? " multicast=\"true\"" : "";
  }
  xml += "/></Interfaces><MaxMessageSize>" + std::to_string(settings.max_message_bytes) +
         "B</MaxMessageSize></General>";
  xml += "<SharedMemory><Enable>false</Enable></SharedMemory>";
  xml +=
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>64"
      "</MaxAutoParticipantIndex>";
  xml += on_loopback ? "<Peers><Peer address=\"127.0.0.1\"/></Peers>" : "";
  xml += "</Discovery>";
  // High-water mark of unacknowledged data: a whole cloud, before the writer blocks.
  xml += "<Internal><Watermarks><WhcHigh>8MB</WhcHigh></Watermarks></Internal>";
  xml += "<Tracing><Verbosity>none</Verbosity></Tracing></Domain>";
  return xml;
}

Participant::Participant(const ParticipantSettings& settings) {
  const ParticipantSettings chosen = with_interface(settings);
  network_interface_ = chosen.network_interface;
  const auto domain_id = static_cast<dds_domainid_t>(chosen.domain_id);
  const std::string on =
      network_interface_.empty() ? std::string() : " on the network interface " + network_interface_;
  // Checked, because after a failure dds_create_participant() would silently use the default configuration.
  domain_ = checked(dds_create_domain(domain_id, domain_configuration(chosen).c_str()),
                    "domain " + std::to_string(chosen.domain_id) + on + " cannot be created");
  const QosPointer qos = make_qos();
  dds_qset_userdata(qos.get(), kUserData.data(), kUserData.size());
  participant_ = checked(dds_create_participant(domain_id, qos.get(), nullptr),
                         "participant in domain " + std::to_string(chosen.domain_id));
}

}  // namespace isobar::dds
