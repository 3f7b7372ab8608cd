// SPDX-License-Identifier: BSD-3-Clause
// CTest runs this program with a /dev/shm of 32 MB.
#include <doctest/doctest.h>
#include <sys/statvfs.h>

#include <chrono>

#include "ipc/shared_memory.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_shared_memory_space {

using namespace isobar::ipc;

namespace {

TEST_CASE("a /dev/shm that is too small is refused with the space needed and available") {
  struct statvfs status {};
  REQUIRE(::statvfs("/dev/shm", &status) == 0);
  if (status.f_bavail * status.f_frsize >= Broker::needed_bytes()) {
    MESSAGE("skipped: without root the test has the /dev/shm of the machine, which is large enough");
    return;
  }
  test::ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  std::string line;
  REQUIRE(broker.read_line(line, std::chrono::seconds(10)));
  const std::string needed = std::to_string((Broker::needed_bytes() + (1U << 20) - 1) >> 20);
  CHECK(line.find(needed + " MB needed") != std::string::npos);
  CHECK(line.find("31 MB available") + line.find("32 MB available") != 2 * std::string::npos);
  CHECK(broker.wait(std::chrono::seconds(5)) == 69);
}

}  // namespace

}  // namespace isobar::test::test_shared_memory_space
