// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "run/mcap/mcap_writer.hpp"

namespace isobar::mcap {

/// A topic of an MCAP file that is declared with its first message: one without messages is not in the file.
class LazyChannel {
 public:
  /// @param type "nav_msgs/msg/Odometry", see McapWriter::add_channel()
  LazyChannel(McapWriter& out, std::string topic, std::string type)
      : out_(&out), topic_(std::move(topic)), type_(std::move(type)) {}

  void write(std::int64_t stamp_ns, std::span<const std::uint8_t> cdr) {
    if (!number_) number_ = out_->add_channel(topic_, type_);
    out_->write(*number_, stamp_ns, cdr);
  }

 private:
  McapWriter* out_;
  std::string topic_;
  std::string type_;
  std::optional<std::uint16_t> number_;
};

}  // namespace isobar::mcap
