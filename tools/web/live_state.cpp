// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/live_state.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace isobar::web {
namespace {

constexpr std::array<const char*, kTopics> kEventNames{"link",     "status", "floors",
                                                       "settings", "map",    "action"};

void append_event(std::string_view name, std::string_view json, std::string& out) {
  out.append("event: ").append(name).append("\ndata: ").append(json).append("\n\n");
}

}  // namespace

void LiveState::put(Topic topic, std::string json) {
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[static_cast<std::size_t>(topic)];
    if (topic != Topic::kStatus && slot.json == json) return;
    slot.json = std::move(json);
    ++slot.version;
  }
  news_.notify_all();
}

void LiveState::add_pose(const PoseRow& row, std::string json) {
  {
    const std::lock_guard lock(mutex_);
    history_.add(row);
    if (poses_.size() >= kWaitingPoses) poses_.pop_front();
    poses_.push_back(std::move(json));
    ++pose_count_;
  }
  news_.notify_all();
}

void LiveState::forget_poses() {
  const std::lock_guard lock(mutex_);
  history_.clear();
}

void LiveState::append_news(Cursor& cursor, std::string& events) const {
  for (std::size_t topic = 0; topic < kTopics; ++topic) {
    if (cursor.versions[topic] == slots_[topic].version) continue;
    cursor.versions[topic] = slots_[topic].version;
    append_event(kEventNames[topic], slots_[topic].json, events);
  }
  const std::uint64_t first_waiting = pose_count_ - poses_.size();
  for (std::uint64_t number = std::max(cursor.pose, first_waiting); number < pose_count_; ++number) {
    append_event("pose", poses_[number - first_waiting], events);
  }
  cursor.pose = pose_count_;
}

bool LiveState::wait_for_news(Cursor& cursor, std::chrono::milliseconds timeout, std::string& events) {
  const auto has_news = [&] {
    return stopped_ || cursor.pose != pose_count_ ||
           !std::equal(slots_.begin(), slots_.end(), cursor.versions.begin(),
                       [](const Slot& slot, std::uint64_t version) { return slot.version == version; });
  };
  std::unique_lock lock(mutex_);
  if (!news_.wait_for(lock, timeout, has_news) || stopped_) return false;
  append_news(cursor, events);
  return true;
}

void LiveState::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  news_.notify_all();
}

bool LiveState::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

std::vector<PoseRow> LiveState::history() const {
  const std::lock_guard lock(mutex_);
  return history_.rows();
}

std::string LiveState::newest(Topic topic) const {
  const std::lock_guard lock(mutex_);
  return slots_[static_cast<std::size_t>(topic)].json;
}

}  // namespace isobar::web
