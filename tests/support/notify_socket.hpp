// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::test {

/// Receiving socket of sd_notify(3), in place of the service manager.
class NotifySocket {
 public:
  NotifySocket() : path_(std::filesystem::temp_directory_path() / ("notify-" + std::to_string(::getpid()))) {
    socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.native().copy(address.sun_path, sizeof(address.sun_path) - 1);
    std::filesystem::remove(path_);
    REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::close(socket_);
    std::filesystem::remove(path_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  std::vector<std::string> messages() {
    std::vector<std::string> all;
    std::array<char, 512> bytes{};
    for (ssize_t length = 0; (length = ::recv(socket_, bytes.data(), bytes.size(), 0)) > 0;) {
      all.emplace_back(bytes.data(), static_cast<std::size_t>(length));
    }
    return all;
  }

 private:
  std::filesystem::path path_;
  int socket_ = -1;
};

}  // namespace isobar::test
