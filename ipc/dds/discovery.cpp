// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/discovery.hpp"

#include <ros2.h>

#include <cstring>

#include "core/errors.hpp"
#include "ipc/dds/messages.hpp"
#include "ipc/dds/qos.hpp"

namespace isobar::dds {
namespace {

/// The message exists with identifiers of 16 and 24 bytes, as two generated types with the same members.
struct Wide {
  using Info = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
  using Node = rmw_dds_common_msg_dds__NodeEntitiesInfo_;
  using Gid = rmw_dds_common_msg_dds__Gid_;
};
struct Humble {
  using Info = rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo_;
  using Node = rmw_dds_common_humble_msg_dds__NodeEntitiesInfo_;
  using Gid = rmw_dds_common_humble_msg_dds__Gid_;
};

dds_topic_descriptor_t descriptor_for(int gid_bytes) {
  dds_topic_descriptor_t descriptor = gid_bytes == 16
                                          ? rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc
                                          : rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo__desc;
  descriptor.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
  return descriptor;
}

template <class Gid>
Gid gid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  if (dds_get_guid(entity, &guid) != DDS_RETCODE_OK) {
    throw ServiceError("DDS: an entity has no GUID");
  }
  Gid gid{};
  static_assert(sizeof(gid.data) >= sizeof(guid.v));
  std::memcpy(gid.data, guid.v, sizeof(guid.v));
  return gid;
}

template <class Gid>
std::vector<Gid> gids_of(const std::vector<dds_entity_t>& entities) {
  std::vector<Gid> gids;
  gids.reserve(entities.size());
  for (const dds_entity_t entity : entities) {
    gids.push_back(gid_of<Gid>(entity));
  }
  return gids;
}

template <class Sequence, class Element>
void point_to(std::vector<Element>& elements, Sequence& sequence) {
  sequence._buffer = elements.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
}

template <class Types>
dds_return_t write_info(dds_entity_t participant, dds_entity_t writer, const std::string& node_namespace,
                        const std::string& node_name, const std::vector<dds_entity_t>& writers,
                        const std::vector<dds_entity_t>& readers) {
  auto writer_gids = gids_of<typename Types::Gid>(writers);
  auto reader_gids = gids_of<typename Types::Gid>(readers);
  std::vector<typename Types::Node> nodes(1);
  nodes[0].node_namespace = text(node_namespace);
  nodes[0].node_name = text(node_name);
  point_to(writer_gids, nodes[0].writer_gid_seq);
  point_to(reader_gids, nodes[0].reader_gid_seq);
  typename Types::Info info{};
  info.gid = gid_of<typename Types::Gid>(participant);
  point_to(nodes, info.node_entities_info_seq);
  return dds_write(writer, &info);
}

}  // namespace

NodeAnnouncement::NodeAnnouncement(dds_entity_t participant, int gid_bytes)
    : participant_(participant), gid_bytes_(gid_bytes), descriptor_(descriptor_for(gid_bytes)) {
  const char* name = "ros_discovery_info";
  topic_ = checked(dds_create_topic(participant, &descriptor_, name, nullptr, nullptr), name);
  const QosPointer qos = endpoint_qos(Delivery::kLatched, 1);
  writer_ = checked(dds_create_writer(participant, topic_.get(), qos.get(), nullptr), name);
}

NodeAnnouncement::~NodeAnnouncement() = default;

void NodeAnnouncement::announce(const std::string& ros_namespace, const std::string& node_name,
                                const std::vector<dds_entity_t>& writers,
                                const std::vector<dds_entity_t>& readers) {
  const std::string node_namespace = "/" + ros_namespace;
  const dds_return_t result =
      gid_bytes_ == 16
          ? write_info<Wide>(participant_, writer_.get(), node_namespace, node_name, writers, readers)
          : write_info<Humble>(participant_, writer_.get(), node_namespace, node_name, writers, readers);
  if (result != DDS_RETCODE_OK) {
    throw ServiceError(std::string("DDS: ros_discovery_info: ") + dds_strretcode(-result));
  }
}

}  // namespace isobar::dds
