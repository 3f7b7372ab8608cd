// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>

#include "drivers/serial/byte_window.hpp"
#include "drivers/serial/port.hpp"
#include "tests/drivers/serial/pseudo_terminal.hpp"

namespace isobar::test::test_port {

namespace {

std::string read_text(serial::Port& port) {
  std::array<std::uint8_t, 64> bytes{};
  const serial::Port::Result result = port.read(bytes);
  REQUIRE(result.error == 0);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(result.count)};
}

}  // namespace

TEST_CASE("every byte passes a port unchanged, both ways, and nothing waiting is no error") {
  const PseudoTerminal terminal;
  serial::Port port(terminal.path(), 115'200);
  REQUIRE(port.open() == 0);
  CHECK(read_text(port).empty());
  std::string all;
  for (int i = 0; i < 32; ++i) all += static_cast<char>(i);  // the control characters that a cooked tty eats
  all += "\x7f\xff\xfa";
  terminal.send(all);
  CHECK(read_text(port) == all);
  CHECK(port.write(std::span(reinterpret_cast<const std::uint8_t*>(all.data()), all.size())) == 0);
  CHECK(terminal.received() == all);
}

TEST_CASE("a port takes any baud rate, and says that a pseudo-terminal has no low-latency mode") {
  const PseudoTerminal terminal;
  for (const int baud : {9'600, 250'000, 921'600, 2'000'000, 123'457}) {
    serial::Port port(terminal.path(), baud);
    CHECK(port.open() == 0);
    CHECK_FALSE(port.low_latency());
  }
  CHECK(serial::Port(terminal.path(), 115'200).line_time_ns(1'152) == 100'000'000);
}

TEST_CASE("a port is held by one program") {
  const PseudoTerminal terminal;
  serial::Port first(terminal.path(), 115'200);
  serial::Port second(terminal.path(), 115'200);
  REQUIRE(first.open() == 0);
  CHECK(second.open() == EBUSY);
  first.close();
  CHECK(second.open() == 0);
}

TEST_CASE("bytes from before the opening are dropped") {
  const PseudoTerminal terminal;
  serial::Port port(terminal.path(), 115'200);
  REQUIRE(port.open() == 0);
  terminal.send("old");
  port.close();
  REQUIRE(port.open() == 0);
  CHECK(read_text(port).empty());
}

TEST_CASE("a device that vanishes is an error of the next read and write, not silence") {
  PseudoTerminal terminal;
  serial::Port port(terminal.path(), 115'200);
  REQUIRE(port.open() == 0);
  terminal.unplug();
  std::array<std::uint8_t, 8> bytes{};
  const int error = port.read(bytes).error;
  CHECK((error == EIO || error == ENODEV));
  CHECK(port.write(bytes) != 0);
  CHECK(port.open() == ENOENT);
  terminal.plug();
  CHECK(port.open() == 0);
}

TEST_CASE("a file that is no tty is refused by name") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "file";
  std::ofstream(path) << "text";
  CHECK(serial::Port(path, 115'200).open() == ENOTTY);
}

TEST_CASE("a byte window gives the bytes in the order received, whatever was dropped") {
  serial::ByteWindow window;
  std::uint8_t put = 0;
  std::uint8_t seen = 0;
  for (int round = 0; round < 300; ++round) {
    const auto room = window.room();
    REQUIRE(room.size() >= 100);
    for (std::size_t i = 0; i < 100; ++i) room[i] = put++;
    window.filled(100);
    const std::size_t take = window.bytes().size() - static_cast<std::size_t>(round % 50);
    for (std::size_t i = 0; i < take; ++i) REQUIRE(window.bytes()[i] == seen++);
    window.drop(take);
  }
}

}  // namespace isobar::test::test_port
