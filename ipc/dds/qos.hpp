// SPDX-License-Identifier: BSD-3-Clause
// Quality of service, as ROS 2 nodes expect it.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>

namespace isobar::dds {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;

[[nodiscard]] QosPointer make_qos();

/// The choices of the design.
enum class Delivery : std::uint8_t {
  kReliable,    ///< every message, to readers that are there
  kLatched,     ///< every message; readers that come later get the last ones (ROS: transient local)
  kBestEffort,  ///< newest first, losses allowed: sensors
};

/// @param depth messages kept for a reader that is slow or, if latched, late, 1 …
[[nodiscard]] QosPointer endpoint_qos(Delivery delivery, int depth);

}  // namespace isobar::dds
