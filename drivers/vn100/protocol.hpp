// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "drivers/serial/imu_protocol.hpp"
#include "drivers/vn100/measurement.hpp"
#include "drivers/vn100/settings.hpp"
#include "drivers/vn100/stream_parser.hpp"

namespace isobar::vn100 {

/// Messages and dialogue of a VN-100: switches its text output off, sets binary output 1, and reads that
/// register back. Then only packets of that output are taken, since others may hold the same sample again. Without
/// configuration any packet that has acceleration and angular rate is taken, and text of the kind as long as no packet
/// has them.
class Protocol final : public serial::ImuProtocol {
 public:
  explicit Protocol(const Settings& settings);

  void restart() noexcept override;
  std::span<std::uint8_t> room() noexcept override { return parser_.room(); }
  void filled(std::size_t count) noexcept override { parser_.filled(count); }
  void give_up_incomplete() noexcept override { parser_.give_up_incomplete(); }
  serial::ImuEvent next() noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> command() const noexcept override;
  [[nodiscard]] const char* command_name() const noexcept override;
  [[nodiscard]] const char* refusal() const noexcept override { return refusal_.data(); }
  [[nodiscard]] const char* heard_instead() const noexcept override;
  [[nodiscard]] std::uint64_t corrupt() const noexcept override { return parser_.counters().corrupt; }

 private:
  struct Command {
    std::string name;    ///< "$VNWRG,75"
    std::string line;    ///< with checksum and line end
    std::string kind;    ///< of the answer, "WRG"
    int number = 0;      ///< register
    std::string values;  ///< of the answer
  };
  /// Writes a register and, after the answer, reads it back.
  void add_commands(int number, const std::string& name, const std::string& values);
  void take_packet(const Frame& frame, serial::ImuEvent& event) noexcept;
  void take_line(const Frame& frame, serial::ImuEvent& event) noexcept;
  void take_text(const Frame& frame, serial::ImuEvent& event) noexcept;
  void take_answer(const Frame& frame, serial::ImuEvent& event) noexcept;
  /// Notes what the message `name` lacks, and the remedy.
  void note_incomplete(const char* name, const Measurement& measurement) noexcept;
  void note_unknown_packets() noexcept;

  bool configure_;
  std::vector<Command> commands_;
  std::vector<std::uint8_t> wanted_header_;
  StreamParser parser_;
  std::size_t done_ = 0;  ///< commands answered
  std::array<char, 96> refusal_{};
  bool measured_ = false;         ///< since restart()
  bool packets_measure_ = false;  ///< a packet had acceleration and angular rate
  std::array<char, 96> heard_{};  ///< what came instead of measurements; empty: nothing
};

}  // namespace isobar::vn100
