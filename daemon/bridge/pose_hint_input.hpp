// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "ipc/dds/endpoints.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Hints that were refused: plain values, trivially copyable.
struct RefusedHints {
  std::uint64_t count = 0;
  const char* rule = "";  ///< that the last one broke; lives as long as the program
};

/// Hints of where the robot is, from DDS to isobard. One thread at a time.
class PoseHintInput {
 public:
  /// @throws ServiceError when a DDS entity cannot be created
  PoseHintInput(dds_entity_t participant, const dds::DdsConfig& config);

  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_.get(); }
  /// Forwards the waiting hints.
  /// @return number of those for which shared memory had no room
  std::uint64_t take();
  [[nodiscard]] const RefusedHints& refused() const noexcept { return refused_; }

 private:
  std::string map_frame_;
  dds::Reader<dds::PoseMessage> reader_;
  ipc::Publisher<ipc::PoseHint> publisher_{ipc::topics::kPoseHint};
  RefusedHints refused_;
};

}  // namespace isobar::bridge
