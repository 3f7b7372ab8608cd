// SPDX-License-Identifier: BSD-3-Clause
#include "tools/foxglove/topic_tap.hpp"

#include <chrono>
#include <utility>

#include "run/mcap/message_definitions.hpp"

namespace isobar::tools::foxglove {

namespace {

std::int64_t system_time_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

TopicTap::TopicTap(const dds::Participant& participant, const std::string& ros_namespace)
    : waitset_(dds::checked(dds_create_waitset(participant.get()), "wait set")) {
  namespace topics = dds::topics;
  const auto add = [&](const auto& topic) {
    readers_.push_back(std::make_unique<dds::RawReader>(participant.get(), topic, ros_namespace));
    dds_set_status_mask(readers_.back()->get(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), readers_.back()->get(), 0);
  };
  add(topics::kPose);
  add(topics::kOdom);
  add(topics::kTf);
  add(topics::kTfStatic);
  add(topics::kAltitude);
  add(topics::kRegisteredScan);
  add(topics::kMapCloud);
  add(topics::kMap);
  add(topics::kFloor);
  add(topics::kFloorName);
  add(topics::kDiagnostics);
}

std::vector<Channel> TopicTap::channels() const {
  std::vector<Channel> channels;
  for (const auto& reader : readers_) {
    channels.push_back({static_cast<std::uint32_t>(channels.size() + 1), reader->ros_topic(),
                        reader->ros_type(), mcap::message_definition(reader->ros_type()),
                        reader->is_latched()});
  }
  return channels;
}

void TopicTap::start(Take take, std::function<void()> turn) {
  thread_ = std::thread([this, take = std::move(take), turn = std::move(turn)] { loop(take, turn); });
}

void TopicTap::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void TopicTap::loop(const Take& take, const std::function<void()>& turn) noexcept {
  while (!stopping_) {
    dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(100));
    for (std::uint32_t i = 0; i < readers_.size(); ++i) {
      readers_[i]->take([&](std::span<const std::uint8_t> cdr) {
        auto data = std::make_shared<Data>();
        data->stamp_ns = system_time_ns();
        data->cdr.assign(cdr.begin(), cdr.end());
        take(i + 1, std::move(data));
      });
    }
    turn();
  }
}

}  // namespace isobar::tools::foxglove
