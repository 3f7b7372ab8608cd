// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/udp/udp.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "core/errors.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

/// Requested socket buffer, 3 s of a VLP-16's packets; the kernel caps it at net.core.rmem_max.
constexpr int kReceiveBufferBytes = 4 * 1024 * 1024;
/// Interval of the attempts to open a socket whose address or port is not there yet.
constexpr std::int64_t kRetryNs = 1'000'000'000;

std::string place(const std::string& address, std::uint16_t port) {
  return "UDP " + address + ":" + std::to_string(port);
}

sockaddr_in parse_address(const std::string& address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1) {
    throw ServiceError(place(address, port) + ": is not an IPv4 address");
  }
  return result;
}

/// Refusals that another moment may lift; any other one is a fault of the configuration.
bool may_pass(int error) { return error != EACCES && error != EPERM && error != EAFNOSUPPORT; }

std::string refusal_text(const std::string& address, std::uint16_t port, int error) {
  const std::string where = place(address, port) + ": ";
  switch (error) {
    case EADDRINUSE:
      return where + "the port is in use by another program, which `ss -lunp` names";
    case EADDRNOTAVAIL:
      return where + "no network interface of this machine has that address, see `ip address`";
    case EACCES:
      return where + "ports below 1024 need the capability CAP_NET_BIND_SERVICE";
    default:
      return where + "cannot be opened: " + std::strerror(error);
  }
}

void set_option(int socket, int option, int value) {
  setsockopt(socket, SOL_SOCKET, option, &value, sizeof value);
}

/// Ancillary data of a datagram: receive time and drop counter.
struct Ancillary {
  std::int64_t realtime_ns = 0;
  std::uint32_t overflow = 0;
  bool has_overflow = false;
};

Ancillary read_ancillary(msghdr& message) {
  Ancillary result;
  for (cmsghdr* entry = CMSG_FIRSTHDR(&message); entry != nullptr; entry = CMSG_NXTHDR(&message, entry)) {
    if (entry->cmsg_level != SOL_SOCKET) {
      continue;
    }
    if (entry->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(entry), sizeof stamp);
      result.realtime_ns = stamp.tv_sec * 1'000'000'000 + stamp.tv_nsec;
    } else if (entry->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&result.overflow, CMSG_DATA(entry), sizeof result.overflow);
      result.has_overflow = true;
    }
  }
  return result;
}

}  // namespace

std::string ipv4_text(std::uint32_t ipv4) {
  const in_addr address{htonl(ipv4)};
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

std::uint32_t ipv4_of(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1 ? ntohl(address.s_addr) : 0;
}

UdpReceiver::UdpReceiver(const std::string& address, std::uint16_t port, ClockSource clocks)
    : address_(address), wanted_port_(port), port_(port), buffer_(65'536), clock_(clocks) {
  static_cast<void>(parse_address(address, port));
  stop_event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  const int error = stop_event_ < 0 ? errno : open();
  if (stop_event_ < 0 || (error != 0 && !may_pass(error))) {
    close(stop_event_);
    throw ServiceError(refusal_text(address, port, error));
  }
}

UdpReceiver::~UdpReceiver() {
  close_socket();
  close(stop_event_);
}

int UdpReceiver::open() noexcept {
  next_attempt_ns_ = monotonic_ns() + kRetryNs;
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(wanted_port_);
  inet_pton(AF_INET, address_.c_str(), &where.sin_addr);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0 || bind(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0) {
    const int error = errno;
    close_socket();
    refusal_.store(error, std::memory_order_relaxed);
    return error;
  }
  set_option(socket_, SO_RCVBUF, kReceiveBufferBytes);
  set_option(socket_, SO_TIMESTAMPNS, 1);
  set_option(socket_, SO_RXQ_OVFL, 1);
  sockaddr_in bound{};
  socklen_t length = sizeof bound;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &length);
  port_.store(ntohs(bound.sin_port), std::memory_order_relaxed);
  last_overflow_ = 0;
  refusal_.store(0, std::memory_order_relaxed);
  return 0;
}

void UdpReceiver::close_socket() noexcept {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

std::string UdpReceiver::waiting_for() const {
  const int error = refusal_.load(std::memory_order_relaxed);
  return error == 0 ? std::string{} : refusal_text(address_, wanted_port_, error);
}

int UdpReceiver::prepare(int timeout_ms) noexcept {
  if (socket_ >= 0) return timeout_ms;
  const std::int64_t due_ns = next_attempt_ns_ - monotonic_ns();
  if (due_ns <= 0) {
    open();
    return 0;  // the caller learns at once how it went
  }
  const int due_ms = static_cast<int>(due_ns / 1'000'000) + 1;
  return timeout_ms < 0 ? due_ms : std::min(timeout_ms, due_ms);
}

UdpReceiver::Status UdpReceiver::receive(ReceivedDatagram& datagram, int timeout_ms) {
  const int wait_ms = prepare(timeout_ms);
  // poll() skips a descriptor below 0.
  std::array<pollfd, 2> waits{pollfd{socket_, POLLIN, 0}, pollfd{stop_event_, POLLIN, 0}};
  const int ready = poll(waits.data(), waits.size(), wait_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) {
    return Status::kTimeout;
  }
  if (ready < 0) {
    return Status::kError;
  }
  return waits[1].revents != 0 ? Status::kStopped : read(datagram);
}

UdpReceiver::Status UdpReceiver::read(ReceivedDatagram& datagram) noexcept {
  iovec bytes{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) std::array<char, 128> control;
  sockaddr_in sender{};
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = recvmsg(socket_, &message, 0);
  if (length < 0) {
    if (errno == EAGAIN || errno == EINTR) return Status::kTimeout;
    refusal_.store(errno, std::memory_order_relaxed);
    next_attempt_ns_ = monotonic_ns();
    close_socket();  // opened anew by the next receive()
    return Status::kError;
  }
  const Ancillary ancillary = read_ancillary(message);
  if (ancillary.has_overflow) {  // the kernel's counter wraps at 2^32
    dropped_.fetch_add(ancillary.overflow - last_overflow_, std::memory_order_relaxed);
    last_overflow_ = ancillary.overflow;
  }
  datagram.payload = {buffer_.data(), static_cast<std::size_t>(length)};
  datagram.stamp_ns =
      ancillary.realtime_ns == 0 ? clock_.now_ns() : clock_.to_robot_ns(ancillary.realtime_ns);
  datagram.sender = {ntohl(sender.sin_addr.s_addr), ntohs(sender.sin_port)};
  datagram.cut = (message.msg_flags & MSG_TRUNC) != 0;
  return Status::kDatagram;
}

void UdpReceiver::pause(int duration_ms) noexcept {
  pollfd wait{stop_event_, POLLIN, 0};
  // A signal may shorten the pause: harmless.
  [[maybe_unused]] const int ready = poll(&wait, 1, duration_ms);
}

void UdpReceiver::stop() noexcept {
  const std::uint64_t one = 1;
  // Fails only when the event's counter is full, and then the event is set.
  [[maybe_unused]] const ssize_t written = write(stop_event_, &one, sizeof one);
}

UdpSender::UdpSender(const std::string& address, std::uint16_t port) {
  const sockaddr_in where = parse_address(address, port);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ >= 0) {
    set_option(socket_, SO_BROADCAST, 1);
  }
  if (socket_ < 0 || connect(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0) {
    const int error = errno;
    close(socket_);
    throw ServiceError(place(address, port) + ": cannot be sent to: " + std::strerror(error));
  }
}

UdpSender::~UdpSender() { close(socket_); }

bool UdpSender::send(std::span<const std::uint8_t> payload) noexcept {
  const auto wanted = static_cast<ssize_t>(payload.size());
  ssize_t sent = ::send(socket_, payload.data(), payload.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno == ECONNREFUSED) {  // ICMP "port unreachable" for an earlier datagram
    sent = ::send(socket_, payload.data(), payload.size(), MSG_NOSIGNAL);
    return sent == wanted || errno == ECONNREFUSED;
  }
  return sent == wanted;
}

}  // namespace isobar
