// SPDX-License-Identifier: BSD-3-Clause
#include "tools/foxglove/client_queue.hpp"

#include <algorithm>
#include <utility>

namespace isobar::tools::foxglove {

void ClientQueue::push(Outgoing message) {
  bytes_ += message.bytes();
  waiting_.push_back(std::move(message));
  // The newest stays, however large: a map that is larger than the limit is sent alone.
  while (bytes_ > max_bytes_) {
    const auto oldest = std::find_if(waiting_.begin(), std::prev(waiting_.end()),
                                     [](const Outgoing& one) { return one.data != nullptr; });
    if (oldest == std::prev(waiting_.end())) return;
    bytes_ -= oldest->bytes();
    waiting_.erase(oldest);
    ++dropped_;
  }
}

void ClientQueue::forget(std::uint32_t subscription) {
  std::erase_if(waiting_, [&](const Outgoing& one) {
    const bool is_of_it = one.data && one.subscription == subscription;
    if (is_of_it) bytes_ -= one.bytes();
    return is_of_it;
  });
}

Outgoing ClientQueue::pop() {
  Outgoing first = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= first.bytes();
  return first;
}

}  // namespace isobar::tools::foxglove
