// SPDX-License-Identifier: BSD-3-Clause
// Reader of a DDS topic that hands messages on as they came, in CDR.
#pragma once

#include <dds/ddsi/ddsi_serdata.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ipc/dds/endpoints.hpp"

namespace isobar::dds {

/// "nav_msgs/msg/Odometry" of the DDS type "nav_msgs::msg::dds_::Odometry_".
[[nodiscard]] std::string ros_type_of(const dds_topic_descriptor_t& descriptor);

/// Reads a topic without decoding it. One thread at a time.
class RawReader {
 public:
  /// @throws ServiceError when the topic or the reader cannot be created
  template <class Message>
  RawReader(dds_entity_t participant, const DdsTopic<Message>& topic, const std::string& ros_namespace)
      : ros_topic_(dds_name(topic, ros_namespace, {}).substr(2)),  // without "rt"
        ros_type_(ros_type_of(*topic.descriptor)),
        is_latched_(topic.delivery == Delivery::kLatched),
        topic_(make_topic(participant, topic, dds_name(topic, ros_namespace, {}))),
        reader_(checked(dds_create_reader(participant, topic_.get(),
                                          endpoint_qos(topic.delivery, topic.depth).get(), nullptr),
                        "reader of " + ros_topic_)) {}

  /// Takes every waiting message and calls `use(bytes)` with encapsulation header and body, valid during the call only.
  template <class Use>
  void take(Use&& use) {
    for (;;) {
      ddsi_serdata* sample = nullptr;
      dds_sample_info_t info{};
      if (dds_takecdr(reader_.get(), &sample, 1, &info, DDS_ANY_STATE) <= 0) return;
      if (info.valid_data) {
        bytes_.resize(ddsi_serdata_size(sample));
        ddsi_serdata_to_ser(sample, 0, bytes_.size(), bytes_.data());
        use(std::span<const std::uint8_t>(bytes_));
      }
      ddsi_serdata_unref(sample);
    }
  }

  [[nodiscard]] const std::string& ros_topic() const noexcept { return ros_topic_; }  ///< "/robot1/odom"
  [[nodiscard]] const std::string& ros_type() const noexcept { return ros_type_; }
  [[nodiscard]] bool is_latched() const noexcept { return is_latched_; }
  [[nodiscard]] dds_entity_t get() const noexcept { return reader_.get(); }

 private:
  std::string ros_topic_;
  std::string ros_type_;
  bool is_latched_;
  Entity topic_;
  Entity reader_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace isobar::dds
