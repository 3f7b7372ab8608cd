// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 discovery: which node the writers and readers of this participant belong to.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>
#include <vector>

#include "ipc/dds/participant.hpp"

namespace isobar::dds {

/// The node of one participant, on the latched topic ros_discovery_info. Ends with this object.
class NodeAnnouncement {
 public:
  /// @param gid_bytes 16 or 24, see DdsConfig::ros_gid_bytes
  /// @throws ServiceError when a DDS entity cannot be created
  NodeAnnouncement(dds_entity_t participant, int gid_bytes);
  ~NodeAnnouncement();
  NodeAnnouncement(const NodeAnnouncement&) = delete;
  NodeAnnouncement& operator=(const NodeAnnouncement&) = delete;

  /// @param ros_namespace such as "robot1"; empty: none
  /// @throws ServiceError when the message cannot be written
  void announce(const std::string& ros_namespace, const std::string& node_name,
                const std::vector<dds_entity_t>& writers, const std::vector<dds_entity_t>& readers);

 private:
  dds_entity_t participant_;
  int gid_bytes_;
  dds_topic_descriptor_t descriptor_;  // Cyclone DDS keeps a pointer to it as long as the topic exists
  Entity topic_;
  Entity writer_;
};

}  // namespace isobar::dds
