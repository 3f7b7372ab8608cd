// SPDX-License-Identifier: BSD-3-Clause
// The log in the journal: a datagram socket in place of journald's, in this test's own mount namespace.
#include "daemon/logging.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

namespace isobar::test::test_logging {

namespace {

using ipc::HealthLevel;

/// Runs a program part in a child whose stderr is a file.
/// @return what it wrote there
template <class Part>
std::string stderr_of(Part&& part) {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    part();
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  return text;
}

void name_stderr_as_journal() {
  struct stat stream {};
  fstat(STDERR_FILENO, &stream);
  setenv("JOURNAL_STREAM", (std::to_string(stream.st_dev) + ":" + std::to_string(stream.st_ino)).c_str(), 1);
}

void log_a_fault_and_a_line() {
  set_up_logging("isobard");
  log_change({.name = "barometer", .level = HealthLevel::kError, .is_fault = true, .text = "no answer"});
  log_change({.name = "imu", .level = HealthLevel::kOk, .is_fault = false, .text = "200.0 per second"});
  spdlog::warn("disk full");
}

}  // namespace

TEST_CASE("on a terminal a line has time, program, level of its content, and the level in no other place") {
  const std::string text = stderr_of(log_a_fault_and_a_line);
  CHECK(text.find(" isobard error: barometer: no answer\n") != std::string::npos);
  CHECK(text.find(" isobard info: imu: 200.0 per second\n") != std::string::npos);
  CHECK(text.find(" isobard warning: disk full\n") != std::string::npos);
}

TEST_CASE("in the journal an entry has its priority and fields, and its message neither time nor level") {
  if (unshare(CLONE_NEWNS) != 0 || mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) {
    MESSAGE("skipped: without root there is no mount namespace for a journal of its own");
    return;
  }
  REQUIRE(mount("tmpfs", "/run", "tmpfs", 0, nullptr) == 0);
  std::filesystem::create_directories("/run/systemd/journal");
  const int journal = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, "/run/systemd/journal/socket");
  REQUIRE(bind(journal, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
  const std::string text = stderr_of([] {
    name_stderr_as_journal();
    log_a_fault_and_a_line();
  });
  CHECK(text.empty());
  const auto next = [journal] {
    std::array<char, 4096> buffer{};
    const ssize_t got = read(journal, buffer.data(), buffer.size());
    return "\n" + std::string(buffer.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  };
  const std::string fault = next();
  for (const char* field :
       {"\nMESSAGE=barometer: no answer\n", "\nPRIORITY=3\n", "\nSYSLOG_IDENTIFIER=isobard\n",
        "\nISOBAR_ENTRY=barometer\n", "\nISOBAR_LEVEL=error\n"}) {
    CAPTURE(fault);
    CHECK(fault.find(field) != std::string::npos);
  }
  CHECK(next().find("\nPRIORITY=6\n") != std::string::npos);
  const std::string line = next();
  CHECK(line.find("\nPRIORITY=4\n") != std::string::npos);
  CHECK(line.find("\nMESSAGE=disk full\n") != std::string::npos);
  close(journal);
}

TEST_CASE("a journal that does not listen gets the line on the stream, with its priority in front") {
  const std::string text = stderr_of([] {
    if (unshare(CLONE_NEWNS) == 0 && mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0) {
      mount("tmpfs", "/run", "tmpfs", 0, nullptr);
      name_stderr_as_journal();
      log_a_fault_and_a_line();
    } else {
      dprintf(STDERR_FILENO, "<3>barometer: no answer\n");  // without root: nothing to test
    }
  });
  CHECK(text.starts_with("<3>barometer: no answer\n"));
}

}  // namespace isobar::test::test_logging
