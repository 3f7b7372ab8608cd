// SPDX-License-Identifier: BSD-3-Clause
// DDS subscriber of a test.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::test {

/// Subscriber of one topic, with waiting.
template <class Message>
class Listener {
 public:
  /// With its own participant, of which a process may have only one at a time.
  explicit Listener(const dds::DdsTopic<Message>& topic, const std::string& ros_namespace = {})
      : Listener(std::make_shared<dds::Participant>(dds::ParticipantSettings{}), topic, ros_namespace) {}
  Listener(std::shared_ptr<dds::Participant> participant, const dds::DdsTopic<Message>& topic,
           const std::string& ros_namespace = {})
      : participant_(std::move(participant)), reader_(participant_->get(), topic, ros_namespace) {
    waitset_ = dds::checked(dds_create_waitset(participant_->get()), "wait set");
    dds_set_status_mask(reader_.get(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), reader_.get(), 0);
  }
  /// Discards the waiting messages.
  void forget() {
    reader_.take([](const Message&) {});
  }
  /// Waits until `wanted` messages for which `fits` holds have been received.
  template <class Fits>
  bool receive(int wanted, Fits&& fits, std::chrono::seconds timeout = std::chrono::seconds(20)) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (wanted > 0 && std::chrono::steady_clock::now() < deadline) {
      dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(100));
      reader_.take([&](const Message& message) { wanted -= fits(message) ? 1 : 0; });
    }
    return wanted <= 0;
  }
  bool receive(int wanted) {
    return receive(wanted, [](const Message&) { return true; });
  }
  [[nodiscard]] const dds::Participant& participant() const { return *participant_; }

 private:
  std::shared_ptr<dds::Participant> participant_;
  dds::Reader<Message> reader_;
  dds::Entity waitset_;
};

/// The status of that name, "node: entry"; nullptr: none.
inline const diagnostic_msgs_msg_dds__DiagnosticStatus_* find_status(const dds::DiagnosticsMessage& message,
                                                                     const std::string& name) {
  for (std::uint32_t i = 0; i < message.status._length; ++i) {
    if (name == message.status._buffer[i].name) {
      return &message.status._buffer[i];
    }
  }
  return nullptr;
}

/// Whether the message has a status of that name and level.
inline bool says(const dds::DiagnosticsMessage& message, const std::string& name, int level) {
  const auto* status = find_status(message, name);
  return status != nullptr && status->level == level;
}

/// Text of the status of that name; empty: none.
inline std::string text_of(const dds::DiagnosticsMessage& message, const std::string& name) {
  const auto* status = find_status(message, name);
  return status != nullptr ? status->message : "";
}

}  // namespace isobar::test
