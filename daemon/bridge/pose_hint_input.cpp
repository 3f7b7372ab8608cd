// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/pose_hint_input.hpp"

#include "ipc/dds/pose_hints.hpp"

namespace isobar::bridge {

PoseHintInput::PoseHintInput(dds_entity_t participant, const dds::DdsConfig& config)
    : map_frame_(config.map_frame),
      reader_(participant, dds::topics::kInitialPose, config.ros_namespace, config.topics.initial_pose,
              config.input_qos.initial_pose) {
  dds_set_status_mask(reader_.get(), DDS_DATA_AVAILABLE_STATUS);
}

std::uint64_t PoseHintInput::take() {
  std::uint64_t without_room = 0;
  reader_.take([&](const dds::PoseMessage& message) {
    ipc::PoseHint hint;
    if (const char* rule = dds::to_hint(message, map_frame_, hint); rule != nullptr) {
      ++refused_.count;
      refused_.rule = rule;
    } else if (!publisher_.send(hint)) {
      ++without_room;
    }
  });
  return without_room;
}

}  // namespace isobar::bridge
