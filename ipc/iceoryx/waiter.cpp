// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/waiter.hpp"

#include <atomic>
#include <iceoryx_posh/popo/user_trigger.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <string>

#include "core/errors.hpp"
#include "ipc/iceoryx/raw_subscriber.hpp"

namespace isobar::ipc {

struct Waiter::Impl {
  iox::popo::UserTrigger trigger;
  iox::popo::WaitSet<Waiter::kMaxSubscribers + 1> set;
  std::atomic<bool> stopped{false};

  template <class Wait>
  Event wait(Wait&& wait_on_set) noexcept {
    if (stopped.load(std::memory_order_acquire)) {
      return Event::kStopped;
    }
    const auto notifications = wait_on_set();
    if (stopped.load(std::memory_order_acquire)) {
      return Event::kStopped;
    }
    return notifications.empty() ? Event::kTimeout : Event::kData;
  }
};

Waiter::Waiter(std::initializer_list<detail::RawSubscriber*> subscribers) : impl_(std::make_unique<Impl>()) {
  bool attached = subscribers.size() <= kMaxSubscribers;
  attached = attached && !impl_->set.attachEvent(impl_->trigger).has_error();
  for (detail::RawSubscriber* subscriber : subscribers) {
    attached = attached &&
               !impl_->set.attachState(subscriber->impl_->subscriber, iox::popo::SubscriberState::HAS_DATA)
                    .has_error();
  }
  if (!attached) {
    throw ServiceError("shared memory: no wait set for " + std::to_string(subscribers.size()) +
                       " subscribers (at most " + std::to_string(kMaxSubscribers) + ")");
  }
}

Waiter::~Waiter() = default;

Waiter::Event Waiter::wait() noexcept {
  return impl_->wait([this] { return impl_->set.wait(); });
}

Waiter::Event Waiter::wait_for(std::chrono::nanoseconds timeout) noexcept {
  const auto limit = iox::units::Duration::fromNanoseconds(timeout.count());
  return impl_->wait([this, limit] { return impl_->set.timedWait(limit); });
}

void Waiter::stop() noexcept {
  impl_->stopped.store(true, std::memory_order_release);
  impl_->trigger.trigger();
}

void Waiter::wake() noexcept { impl_->trigger.trigger(); }

}  // namespace isobar::ipc
