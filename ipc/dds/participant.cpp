// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/participant.hpp"

#include <string_view>

#include "core/errors.hpp"
#include "core/text_list.hpp"
#include "ipc/dds/qos.hpp"

namespace isobar::dds {
namespace {

/// User data of a participant as ROS 2's rmw sets it; ROS 2 tools ignore participants without it.
constexpr std::string_view kUserData = "enclave=/;";

/// Linux's loopback carries multicast although its interface flags lack IFF_MULTICAST, so the configuration
/// has to enable it. By address, because an interface can have several.
std::string interfaces_xml(const std::vector<Interface>& interfaces) {
  std::string xml = "<Interfaces>";
  for (const Interface& interface : interfaces) {
    xml += "<NetworkInterface address=\"" + interface.address + "\"";
    xml += interface.is_loopback ? " multicast=\"true\"/>" : "/>";
  }
  return xml + "</Interfaces>";
}

/// Subscribers of this machine that do not use multicast on loopback are found by unicast.
std::string peers_xml(const std::vector<std::string>& peers) {
  std::string xml = "<Peers><Peer address=\"127.0.0.1\"/>";
  for (const std::string& peer : peers) xml += "<Peer address=\"" + peer + "\"/>";
  return xml + "</Peers>";
}

}  // namespace

Entity checked(dds_entity_t handle, const std::string& what) {
  if (handle < 0) {
    throw ServiceError("DDS: " + what + ": " + dds_strretcode(-handle));
  }
  return Entity(handle);
}

std::string domain_configuration(const ParticipantSettings& settings,
                                 const std::vector<Interface>& interfaces) {
  std::string xml = "<Domain Id=\"any\"><General>";
  xml += settings.uri_names_interfaces || interfaces.empty() ? "" : interfaces_xml(interfaces);
  xml += "<MaxMessageSize>" + std::to_string(settings.max_message_bytes) + "B</MaxMessageSize></General>";
  xml += "<SharedMemory><Enable>false</Enable></SharedMemory>";
  xml +=
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>64"
      "</MaxAutoParticipantIndex>";
  xml += peers_xml(split_list(settings.peers)) + "</Discovery>";
  // High-water mark of unacknowledged data: a whole map, before the writer blocks. Linger duration: a writer
  // that is taken away waits for acknowledgements so long at most; a reader whose address has gone never
  // sends any, and by default (1 s) the subscribers that are still there would miss as many poses.
  xml += "<Internal><Watermarks><WhcHigh>64MB</WhcHigh></Watermarks>";
  xml += "<WriterLingerDuration>100ms</WriterLingerDuration></Internal>";
  xml += "<Tracing><Verbosity>none</Verbosity></Tracing></Domain>";
  return settings.uri.empty() ? xml : xml + "," + settings.uri;
}

Participant::Participant(const ParticipantSettings& settings)
    : Participant(settings, choose_interfaces(interfaces_up(), split_list(settings.network_interface))) {}

Participant::Participant(const ParticipantSettings& settings, const InterfaceChoice& choice)
    : interfaces_(choice) {
  const auto domain_id = static_cast<dds_domainid_t>(settings.domain_id);
  // Checked, because after a failure dds_create_participant() would silently use the default configuration.
  domain_ = checked(
      dds_create_domain(domain_id, domain_configuration(settings, choice.used).c_str()),
      "domain " + std::to_string(settings.domain_id) + " on " + text_of(choice.used) + " cannot be created");
  const QosPointer qos = make_qos();
  dds_qset_userdata(qos.get(), kUserData.data(), kUserData.size());
  participant_ = checked(dds_create_participant(domain_id, qos.get(), nullptr),
                         "participant in domain " + std::to_string(settings.domain_id));
}

}  // namespace isobar::dds
