// SPDX-License-Identifier: BSD-3-Clause
// A serial port whose other end is the test: a pseudo-terminal behind a symbolic link, as udev makes one for a
// USB adapter.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/serial/port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test {

class PseudoTerminal {
 public:
  PseudoTerminal() { plug(); }
  ~PseudoTerminal() { unplug(); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  [[nodiscard]] std::string path() const { return (folder_.path() / "imu").string(); }
  [[nodiscard]] bool plugged() const { return master_ >= 0; }

  void plug() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    std::array<char, 64> name{};
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name.data(), name.size()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    std::filesystem::create_symlink(name.data(), path());
    // Raw from the beginning: a terminal's echo would return what the sensor sends before the port is open.
    if (serial::Port(path(), 9'600).open() != 0) throw std::runtime_error("no raw pseudo-terminal");
  }
  /// As a USB adapter that is pulled: the open port hangs up and its name is gone.
  void unplug() {
    if (master_ >= 0) close(master_);
    master_ = -1;
    std::error_code ignored;
    std::filesystem::remove(path(), ignored);
  }

  void send(std::span<const std::uint8_t> bytes) const {
    if (master_ < 0) return;
    [[maybe_unused]] const ssize_t count = write(master_, bytes.data(), bytes.size());
  }
  void send(const std::string& text) const {
    send(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }
  /// What the device wrote since the last call.
  [[nodiscard]] std::string received() const {
    std::array<char, 1024> bytes{};
    const ssize_t count = master_ >= 0 ? read(master_, bytes.data(), bytes.size()) : 0;
    return count > 0 ? std::string(bytes.data(), static_cast<std::size_t>(count)) : std::string{};
  }

 private:
  TemporaryFolder folder_;
  int master_ = -1;
};

}  // namespace isobar::test
