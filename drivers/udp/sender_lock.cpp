// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/udp/sender_lock.hpp"

#include <algorithm>

namespace isobar {

bool SenderLock::admits(const SenderAddress& sender, std::int64_t now_ns) noexcept {
  if (!is_allowed(sender.ipv4)) return refuse(sender, now_ns);
  if (status_.in_use.ipv4 == 0 || status_.in_use == sender) return admit(sender, now_ns);
  if (now_ns - heard_ns_ > kTakeoverNs) {
    ++status_.takeovers;
    status_.takeover_ns = now_ns;
    contested_ = false;
    earlier_port_ = 0;
    return admit(sender, now_ns);
  }
  if (status_.in_use.ipv4 != sender.ipv4) return refuse(sender, now_ns);
  if (sender.port == earlier_port_ && !contested_) {
    contested_ = true;
    const SenderAddress later = status_.in_use;
    admit(sender, now_ns);
    static_cast<void>(refuse(later, now_ns));
    return true;
  }
  if (contested_ || is_port_alive(now_ns)) return refuse(sender, now_ns);
  earlier_port_ = status_.in_use.port;
  return admit(sender, now_ns);
}

bool SenderLock::is_allowed(std::uint32_t ipv4) const noexcept {
  return allowed_.empty() || std::find(allowed_.begin(), allowed_.end(), ipv4) != allowed_.end();
}

// A program that opens a socket for each datagram is never alive in this sense: its ports send once.
bool SenderLock::is_port_alive(std::int64_t now_ns) const noexcept {
  return gap_ns_ > 0 && now_ns - heard_ns_ < std::clamp(3 * gap_ns_, kLeastPortWaitNs, kMostPortWaitNs);
}

bool SenderLock::admit(const SenderAddress& sender, std::int64_t now_ns) noexcept {
  if (status_.in_use == sender) {
    constexpr std::int64_t kForgetting = 16;  // samples
    gap_ns_ = std::max({std::int64_t{1}, now_ns - heard_ns_, gap_ns_ - gap_ns_ / kForgetting});
  } else {
    gap_ns_ = 0;
  }
  status_.in_use = sender;
  heard_ns_ = now_ns;
  return true;
}

bool SenderLock::refuse(const SenderAddress& sender, std::int64_t now_ns) noexcept {
  status_.other = sender;
  status_.other_ns = now_ns;
  ++status_.refused;
  return false;
}

}  // namespace isobar
