// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/udp_proxy.hpp"

#include <algorithm>
#include <utility>

#include "drivers/clock/robot_clock.hpp"

namespace isobar::test {

UdpProxy::UdpProxy(std::uint16_t from_port, std::uint16_t to_port, LinkFaults faults, std::uint32_t seed)
    : receiver_("127.0.0.1", from_port),
      sender_("127.0.0.1", to_port),
      faults_(std::move(faults)),
      random_(seed),
      thread_([this] { pass_on(); }) {}

UdpProxy::~UdpProxy() {
  receiver_.stop();
  thread_.join();
}

LinkCounts UdpProxy::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::vector<DarkSpan> UdpProxy::dark_spans() const {
  const std::lock_guard lock(mutex_);
  return spans_;
}

void UdpProxy::pass_on() {
  ReceivedDatagram datagram;
  for (;;) {
    const UdpReceiver::Status status = receiver_.receive(datagram, -1);
    if (status == UdpReceiver::Status::kStopped) return;
    if (status != UdpReceiver::Status::kDatagram) continue;
    const std::lock_guard lock(mutex_);
    take({datagram.payload.begin(), datagram.payload.end()});
  }
}

bool UdpProxy::is_dark(std::int64_t now_ns) {
  if (first_ns_ == 0) first_ns_ = now_ns;
  const double since_s = static_cast<double>(now_ns - first_ns_) * 1e-9;
  const bool dark = std::ranges::any_of(faults_.dark, [since_s](const LinkFaults::Span& span) {
    return since_s >= span.from_s && since_s < span.to_s;
  });
  const bool was_dark = !spans_.empty() && spans_.back().first_after_ns == 0;
  if (dark && !was_dark) spans_.push_back({last_sent_ns_, 0});
  if (!dark && was_dark) spans_.back().first_after_ns = now_ns;
  return dark;
}

void UdpProxy::take(const std::vector<std::uint8_t>& bytes) {
  ++counts_.received;
  if (is_dark(monotonic_ns())) {
    counts_.dark += held_.empty() ? 1 : 2;
    held_.clear();
    return;
  }
  const std::vector<std::uint8_t> held = std::exchange(held_, {});
  fault(bytes);
  if (!held.empty()) send(held);
}

void UdpProxy::fault(std::vector<std::uint8_t> bytes) {
  double chance = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
  const auto happens = [&chance](double probability) {
    const bool is_it = chance >= 0.0 && chance < probability;
    chance -= probability;
    return is_it;
  };
  if (happens(faults_.drop)) {
    ++counts_.dropped;
    return;
  }
  if (happens(faults_.reorder)) {
    ++counts_.reordered;
    held_ = std::move(bytes);
    return;
  }
  if (happens(faults_.truncate)) {
    ++counts_.truncated;
    bytes.resize(std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random_));
  }
  if (happens(faults_.corrupt)) {
    constexpr std::size_t kNoiseBytes = 32;
    ++counts_.corrupted;
    std::generate_n(bytes.begin(), std::min(bytes.size(), kNoiseBytes),
                    [this] { return static_cast<std::uint8_t>(random_()); });
  }
  send(bytes);
  if (happens(faults_.duplicate)) {
    ++counts_.duplicated;
    send(bytes);
  }
}

void UdpProxy::send(const std::vector<std::uint8_t>& bytes) {
  sender_.send(bytes);
  last_sent_ns_ = monotonic_ns();
}

}  // namespace isobar::test
