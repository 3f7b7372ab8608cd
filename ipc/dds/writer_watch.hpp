// SPDX-License-Identifier: BSD-3-Clause
// Writers of a topic from which its reader gets nothing, because type or quality of service does not fit.
#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

#include "ipc/dds/participant.hpp"

namespace isobar::dds {

/// A reader, and the name of its input in the settings: "imu" for dds.topics.imu and dds.qos.imu_….
struct InputReader {
  const char* input;
  dds_entity_t reader;
};

/// ROS name of a DDS type: "sensor_msgs::msg::dds_::Imu_" is "sensor_msgs/msg/Imu". Unprintable bytes become '?'.
[[nodiscard]] std::string ros_type_name(const std::string& dds_type);

/// Looks for such writers among those that discovery has found.
///
/// Quality of service: the reader's status says which policy does not fit. Type: Cyclone DDS 0.10 neither matches nor
/// reports such a writer (its inconsistent-topic status stays 0), but lists it among the discovered ones. One thread.
class WriterWatch {
 public:
  /// Discovered writers that are looked at; further ones are not seen.
  static constexpr std::size_t kMostWriters = 512;

  /// @throws ServiceError when the list of writers cannot be opened
  explicit WriterWatch(dds_entity_t participant);

  /// Forgets the writers of the last look and takes those of now.
  void look();
  /// Why no writer fits, with the remedy, at most 119 bytes; empty while one does, or none is there. Requires a reader
  /// of the same domain.
  [[nodiscard]] std::string trouble(const InputReader& input) const;

 private:
  struct Found {
    std::string topic;
    std::string type;
  };
  Entity list_;
  std::vector<Found> writers_;
};

}  // namespace isobar::dds
