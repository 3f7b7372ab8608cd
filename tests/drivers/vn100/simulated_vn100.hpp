// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

#include "drivers/vn100/text_line.hpp"
#include "tests/drivers/serial/pseudo_terminal.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"

namespace isobar::test {

/// A VN-100 that answers register commands and sends what register 75 says.
class SimulatedVn100 {
 public:
  void serve(std::int64_t now_ns) {
    if (!terminal.plugged()) {
      was_plugged_ = false;
      return;
    }
    if (!was_plugged_) power_on(now_ns);
    input_ += terminal.received();
    for (std::size_t end = input_.find("\r\n"); end != std::string::npos; end = input_.find("\r\n")) {
      if (hears) answer(input_.substr(0, end));
      input_.erase(0, end + 2);
    }
    const int divisor = registers_[75].empty() ? 0 : std::stoi(registers_[75].substr(2));
    while (divisor > 0 && sends && now_ns >= next_ns_) {
      terminal.send(own_packet(static_cast<std::uint64_t>(next_ns_ - started_ns_), rate_z_, pressure_kpa));
      if (registers_[6] != "0") terminal.send("$VNYMR,+100.949,+000.001*65\r\n");
      rate_z_ += frozen ? 0.0F : 1e-4F;
      next_ns_ += divisor * 1'250'000LL;
    }
    if (divisor == 0) next_ns_ = now_ns;
  }

  PseudoTerminal terminal;
  bool hears = true;
  bool sends = true;
  bool frozen = false;
  float pressure_kpa = 101.0F;
  std::string refusal;      ///< instead of accepting register 75
  std::string read_back;    ///< held in register 75 instead of what was written
  int damaged_answers = 0;  ///< answers sent with a wrong checksum

 private:
  void power_on(std::int64_t now_ns) {
    was_plugged_ = true;
    registers_ = {{6, "14"}, {75, ""}};
    started_ns_ = next_ns_ = now_ns;
  }
  void answer(const std::string& line) {
    const auto command = vn100::parse_answer(line);
    std::string body = line.substr(1, line.find('*') - 1);
    if (!command || vn100::command_line(body) != line + "\r\n")
      throw std::runtime_error("no command: " + line);
    if (command->kind == "WRG" && command->number == 75 && !refusal.empty()) {
      body = refusal;
    } else if (command->kind == "WRG") {
      registers_[command->number] =
          command->number == 75 && !read_back.empty() ? read_back : std::string(command->values);
    } else {
      body += "," + registers_[command->number];
    }
    std::string reply = vn100::command_line(body);
    if (damaged_answers > 0) {
      --damaged_answers;
      reply[3] ^= 1;
    }
    terminal.send(reply);
  }

  std::map<int, std::string> registers_;
  std::string input_;
  bool was_plugged_ = false;
  std::int64_t started_ns_ = 0;
  std::int64_t next_ns_ = 0;
  float rate_z_ = 0.25F;
};

}  // namespace isobar::test
