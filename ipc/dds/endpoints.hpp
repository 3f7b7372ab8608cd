// SPDX-License-Identifier: BSD-3-Clause
// Writer and reader of a DDS topic.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "ipc/dds/participant.hpp"
#include "ipc/dds/topics.hpp"
#include "ipc/dds_config.hpp"

namespace isobar::dds {

/// Settings of a reader: those of the topics' table, or as configured.
template <class Message>
[[nodiscard]] QosPointer reader_qos(const DdsTopic<Message>& topic,
                                    const std::optional<InputQos>& configured) {
  if (!configured) return endpoint_qos(topic.delivery, topic.depth);
  return endpoint_qos(
      configured->reliability == Reliability::kReliable ? Delivery::kReliable : Delivery::kBestEffort,
      configured->depth);
}

/// @throws ServiceError when the topic cannot be created
template <class Message>
[[nodiscard]] Entity make_topic(dds_entity_t participant, const DdsTopic<Message>& topic,
                                const std::string& name) {
  return checked(dds_create_topic(participant, topic.descriptor, name.c_str(), nullptr, nullptr),
                 "topic " + name);
}

/// Number of readers that are matched with a writer.
[[nodiscard]] inline std::uint32_t readers_of(dds_entity_t writer) noexcept {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

/// Writes a topic. One thread at a time.
template <class Message>
class Writer {
 public:
  /// @throws ServiceError when the topic or the writer cannot be created
  /// @param ros_name see dds_name()
  Writer(dds_entity_t participant, const DdsTopic<Message>& topic, const std::string& ros_namespace = {},
         const std::string& ros_name = {}) {
    const std::string name = dds_name(topic, ros_namespace, ros_name);
    const QosPointer qos = endpoint_qos(topic.delivery, topic.depth);
    topic_ = make_topic(participant, topic, name);
    writer_ = checked(dds_create_writer(participant, topic_.get(), qos.get(), nullptr), "writer of " + name);
  }

  /// @return false when a slow reader blocked the writer for too long; counted in failures()
  bool write(const Message& message) noexcept {
    if (dds_write(writer_.get(), &message) == DDS_RETCODE_OK) {
      return true;
    }
    ++failures_;
    return false;
  }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_; }
  [[nodiscard]] dds_entity_t get() const noexcept { return writer_.get(); }

  /// Whether a reader is matched. Latched topics must be written even without one: readers may come later.
  [[nodiscard]] bool has_readers() const noexcept { return readers_of(writer_.get()) > 0; }

 private:
  Entity topic_;
  Entity writer_;
  std::uint64_t failures_ = 0;
};

/// Reads a topic. One thread at a time.
template <class Message>
class Reader {
 public:
  /// @throws ServiceError when the topic or the reader cannot be created
  /// @param ros_name see dds_name()
  Reader(dds_entity_t participant, const DdsTopic<Message>& topic, const std::string& ros_namespace = {},
         const std::string& ros_name = {}, const std::optional<InputQos>& configured = {}) {
    const std::string name = dds_name(topic, ros_namespace, ros_name);
    const QosPointer qos = reader_qos(topic, configured);
    topic_ = make_topic(participant, topic, name);
    reader_ = checked(dds_create_reader(participant, topic_.get(), qos.get(), nullptr), "reader of " + name);
  }

  /// Takes every waiting message and calls `use(const Message&)`, or `use(const Message&, writer)` with the
  /// instance handle of its writer. A message is valid during its call only.
  /// @return number of messages
  template <class Use>
  int take(Use&& use) {
    int used = 0;
    for (;;) {
      void* sample = nullptr;
      dds_sample_info_t info{};
      if (dds_take(reader_.get(), &sample, &info, 1, 1) <= 0) {
        return used;
      }
      if (info.valid_data) {
        const auto& message = *static_cast<const Message*>(sample);
        if constexpr (std::is_invocable_v<Use, const Message&, dds_instance_handle_t>) {
          use(message, info.publication_handle);
        } else {
          use(message);
        }
        ++used;
      }
      dds_return_loan(reader_.get(), &sample, 1);
    }
  }
  [[nodiscard]] dds_entity_t get() const noexcept { return reader_.get(); }

  /// Whether this writer is still matched. Always true when more than 64 writers are matched.
  [[nodiscard]] bool is_matched(dds_instance_handle_t writer) const noexcept {
    std::array<dds_instance_handle_t, 64> writers{};
    const dds_return_t count = dds_get_matched_publications(reader_.get(), writers.data(), writers.size());
    if (count < 0 || static_cast<std::size_t>(count) > writers.size()) {
      return true;
    }
    const auto end = writers.begin() + count;
    return std::find(writers.begin(), end, writer) != end;
  }

 private:
  Entity topic_;
  Entity reader_;
};

}  // namespace isobar::dds
