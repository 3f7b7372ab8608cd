// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/live/listeners.hpp"

#include "drivers/clock/robot_clock.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::benchmark {

PoseListener::PoseListener()
    : participant_(dds::ParticipantSettings{}), reader_(participant_.get(), dds::topics::kPose) {
  waitset_ = dds::checked(dds_create_waitset(participant_.get()), "wait set");
  dds_set_status_mask(reader_.get(), DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset_.get(), reader_.get(), 0);
  thread_ = std::thread([this] { listen(); });
}

PoseListener::~PoseListener() {
  stopping_ = true;
  thread_.join();
}

void PoseListener::listen() {
  while (!stopping_) {
    dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(100));
    const std::int64_t now_ns = RobotClock::now_ns();
    reader_.take([&](const dds::PoseMessage& message) {
      const std::lock_guard lock(mutex_);
      poses_.push_back({dds::to_stamp_ns(message.header.stamp), now_ns});
    });
  }
}

std::vector<Event> PoseListener::poses() const {
  const std::lock_guard lock(mutex_);
  return poses_;
}

MemoryListener::MemoryListener(bool queues)
    : attachment_("live-benchmark", std::chrono::seconds(10)), health_(ipc::topics::kHealth) {
  if (queues) {
    queues_.emplace();
    waiter_.emplace(std::initializer_list<ipc::detail::RawSubscriber*>{
        &queues_->scans.raw(), &queues_->priors.raw(), &queues_->poses.raw(), &queues_->registered.raw(),
        &health_.raw()});
  } else {
    waiter_.emplace(std::initializer_list<ipc::detail::RawSubscriber*>{&health_.raw()});
  }
  thread_ = std::thread([this] { listen(); });
}

MemoryListener::~MemoryListener() {
  waiter_->stop();
  thread_.join();
}

void MemoryListener::listen() {
  while (waiter_->wait() != ipc::Waiter::Event::kStopped) drain();
}

void MemoryListener::drain() {
  const std::int64_t now_ns = RobotClock::now_ns();
  const std::lock_guard lock(mutex_);
  if (queues_) {
    while (const auto scan = queues_->scans.take()) events_.scans.push_back({scan->end_stamp_ns, now_ns});
    while (const auto prior = queues_->priors.take()) events_.priors.push_back({prior->stamp_ns, now_ns});
    while (const auto pose = queues_->poses.take()) events_.poses.push_back({pose->stamp_ns, now_ns});
    while (const auto scan = queues_->registered.take()) {
      events_.wake_ups.push_back({scan->handed_over_ns, now_ns});
    }
  }
  if (const auto report = health_.take_latest()) {
    events_.health.clear();
    for (std::uint32_t i = 0; i < report->entry_count; ++i) {
      events_.health[report->entries[i].name] = report->entries[i].value;
    }
  }
}

MemoryEvents MemoryListener::events() const {
  const std::lock_guard lock(mutex_);
  return events_;
}

}  // namespace isobar::benchmark
