// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace isobar::recording {

/// UDP packets by destination port, of those that nobody wanted: what a capture holds instead of the lidar's. Bounded:
/// ports after the first kMost are counted together.
class PortsSeen {
 public:
  static constexpr std::size_t kMost = 16;

  void add(std::uint16_t port) {
    std::size_t k = 0;
    while (k < used_ && ports_[k] != port) ++k;
    if (k == kMost) {
      ++others_;
      return;
    }
    if (k == used_) ports_[used_++] = port;
    ++counts_[k];
  }

  /// Packets for one port, 0 unless among the first kMost ports.
  [[nodiscard]] std::uint64_t count(std::uint16_t port) const {
    for (std::size_t k = 0; k < used_; ++k) {
      if (ports_[k] == port) return counts_[k];
    }
    return 0;
  }
  /// Packets of the busiest port but one.
  [[nodiscard]] std::uint64_t most_but(std::uint16_t port) const {
    std::uint64_t most = others_;
    for (std::size_t k = 0; k < used_; ++k) {
      if (ports_[k] != port && counts_[k] > most) most = counts_[k];
    }
    return most;
  }
  [[nodiscard]] bool empty() const { return used_ == 0; }

  /// "75 packets for port 2370, 1 packet for port 53"; empty without any. In the order of the capture.
  [[nodiscard]] std::string text() const {
    std::string text;
    const auto add_text = [&text](std::uint64_t count, const std::string& where) {
      text +=
          (text.empty() ? "" : ", ") + std::to_string(count) + (count == 1 ? " packet" : " packets") + where;
    };
    for (std::size_t k = 0; k < used_; ++k) add_text(counts_[k], " for port " + std::to_string(ports_[k]));
    if (others_ > 0) add_text(others_, " for other ports");
    return text;
  }

 private:
  std::array<std::uint16_t, kMost> ports_{};
  std::array<std::uint64_t, kMost> counts_{};
  std::size_t used_ = 0;
  std::uint64_t others_ = 0;
};

}  // namespace isobar::recording
