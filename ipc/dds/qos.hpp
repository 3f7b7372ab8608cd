// SPDX-License-Identifier: BSD-3-Clause
// Quality-of-service settings, compatible with ROS 2 nodes.
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

/// Delivery of a topic.
enum class Delivery : std::uint8_t {
  kReliable,    ///< lossless for matched readers
  kLatched,     ///< lossless; late readers get the last `depth` messages (DDS: transient local)
  kBestEffort,  ///< losses allowed, for sensors
};

/// @param depth messages kept for slow readers and, if latched, for late ones, >= 1
[[nodiscard]] QosPointer endpoint_qos(Delivery delivery, int depth);

}  // namespace isobar::dds
