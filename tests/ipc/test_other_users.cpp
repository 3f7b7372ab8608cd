// SPDX-License-Identifier: BSD-3-Clause
// Shared memory beside other users: what their killed programs left, files and locks that they put in the way,
// and who may attach.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_other_users {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;

constexpr const char* kNobody = "65534";
/// The user `daemon`, which has no rights either.
constexpr const char* kOther = "1";

/// The command, run by this user with the group of the same number.
std::vector<std::string> as(const std::string& user, const std::vector<std::string>& command) {
  std::vector<std::string> words{"/usr/bin/setpriv", "--reuid", user, "--regid", user, "--clear-groups"};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

bool is_isolated() {
  if (std::getenv("ISOBAR_ISOLATED") != nullptr && ::geteuid() == 0) return true;
  MESSAGE("skipped: other users need root and namespaces");
  return false;
}

void kill_hard(ChildProcess& program) {
  program.signal(SIGKILL);
  CHECK(program.wait(5s) == 128 + SIGKILL);
}

/// Files of this user in the folders of shared memory.
int files_of(uid_t user) {
  int count = 0;
  for (const char* folder : {"/dev/shm", "/tmp"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      struct stat status {};
      count += ::lstat(entry.path().c_str(), &status) == 0 && status.st_uid == user ? 1 : 0;
    }
  }
  return count;
}

void remove_all() {
  for (const char* folder : {"/dev/shm", "/tmp"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::error_code not_empty;  // the source tree may be below /tmp
      std::filesystem::remove(entry.path(), not_empty);
    }
  }
}

}  // namespace

TEST_CASE("what a killed broker of another user left is removed by root, its segment included") {
  if (!is_isolated()) return;
  remove_all();
  {
    ChildProcess broker(as(kNobody, {ISOBAR_IPC_PEER, "broker"}));
    REQUIRE(broker.read_until("ready", 10s));
    kill_hard(broker);
  }
  CHECK(files_of(65534) >= 6);
  ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  CHECK(broker.read_until("ready", 10s));
  CHECK(files_of(65534) == 0);
  ChildProcess reader({ISOBAR_IPC_PEER, "read", "10"});
  CHECK(reader.wait(10s) == 0);
}

TEST_CASE("what root's killed broker left is named at once, with the command that removes it") {
  if (!is_isolated()) return;
  remove_all();
  {
    ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
    REQUIRE(broker.read_until("ready", 10s));
    kill_hard(broker);
  }
  ChildProcess broker(as(kNobody, {ISOBAR_IPC_PEER, "broker"}));
  std::string line;
  REQUIRE(broker.read_line(line, 10s));
  CAPTURE(line);
  for (const char* part : {"/dev/shm/isobar.lock", "/dev/shm/iceoryx_mgmt", "/tmp/iox-unique-roudi.lock",
                           "/tmp/roudi ", "/dev/shm/root", "user root", "sudo rm "}) {
    CAPTURE(part);
    CHECK(line.find(part) != std::string::npos);
  }
  CHECK_FALSE(broker.read_line(line, 2s));  // one line
  CHECK(broker.wait(5s) == 69);
}

TEST_CASE("a lock file that another user made first does not stop root, and is waited for by others") {
  if (!is_isolated()) return;
  remove_all();
  ChildProcess(as(kNobody, {"/usr/bin/touch", "/dev/shm/isobar.lock"})).wait(5s);
  REQUIRE(files_of(65534) == 1);
  {
    ChildProcess patient(as(kOther, {ISOBAR_IPC_PEER, "patient"}));
    CHECK(patient.read_until("waiting: shared memory: /dev/shm/isobar.lock left by user nobody", 10s));
    CHECK(std::filesystem::remove("/dev/shm/isobar.lock"));
    CHECK(patient.read_until("ready", 10s));
  }
  remove_all();
  ChildProcess(as(kNobody, {"/usr/bin/touch", "/dev/shm/isobar.lock"})).wait(5s);
  ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  CHECK(broker.read_until("ready", 10s));
  struct stat status {};
  CHECK(::stat("/dev/shm/isobar.lock", &status) == 0);
  CHECK(status.st_uid == 0);
  CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE(
    "a folder, a pipe or a link of another user in the place of a file does not stop root, nor others for "
    "good") {
  if (!is_isolated()) return;
  for (const char* make : {"mkdir $f", "mkfifo -m 666 $f", "ln -s /etc/passwd $f"}) {
    CAPTURE(make);
    const auto obstruct = [make] {
      remove_all();
      const std::string names =
          "/dev/shm/isobar.lock /dev/shm/iceoryx_mgmt /tmp/iox-unique-roudi.lock /tmp/roudi /tmp/roudi.lock "
          "/dev/shm/root /dev/shm/daemon";
      ChildProcess maker(as(kNobody, {"/bin/sh", "-c", "for f in " + names + "; do " + make + "; done"}));
      REQUIRE(maker.wait(5s) == 0);
      REQUIRE(files_of(65534) == 7);
    };
    obstruct();
    {
      ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
      CHECK(broker.read_until("ready", 10s));
    }
    obstruct();
    ChildProcess patient(as(kOther, {ISOBAR_IPC_PEER, "patient"}));
    CHECK(patient.read_until("user nobody", 10s));
    ChildProcess attaching(as(kOther, {ISOBAR_IPC_PEER, "read", "1"}));
    CHECK(attaching.wait(10s) == 69);  // and does not hang
    remove_all();
    CHECK(patient.read_until("ready", 10s));
  }
}

TEST_CASE("a lock that another user holds without a broker does not stop root, and is waited for by others") {
  if (!is_isolated()) return;
  remove_all();
  ChildProcess squatter(
      as(kNobody, {"/usr/bin/flock", "/tmp/iox-unique-roudi.lock", "sh", "-c", "echo held; sleep 60"}));
  REQUIRE(squatter.read_until("held", 5s));
  {
    ChildProcess patient(as(kOther, {ISOBAR_IPC_PEER, "patient"}));
    CHECK(patient.read_until(
        "waiting: shared memory: /tmp/iox-unique-roudi.lock of user nobody is locked by process", 10s));
  }
  ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  CHECK(broker.read_until("ready", 10s));
}

TEST_CASE("a user outside of the group may not attach and gets one sentence with the remedy") {
  if (!is_isolated()) return;
  remove_all();
  ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(broker.read_until("ready", 10s));
  const std::vector<std::vector<std::string>> strangers{
      as(kNobody, {ISOBAR_IPC_PEER, "read", "1"}),
      // The group alone ended in a segmentation fault inside iceoryx.
      {"/usr/bin/setpriv", "--reuid", kNobody, "--regid", "0", "--clear-groups", ISOBAR_IPC_PEER, "read",
       "1"}};
  for (const auto& command : strangers) {
    ChildProcess stranger(command);
    std::string line;
    REQUIRE(stranger.read_line(line, 2s));
    CHECK(line.find("only members of its group root may attach") != std::string::npos);
    CHECK_FALSE(stranger.read_line(line, 1s));
    CHECK(stranger.wait(2s) == 69);
  }
  CHECK(broker.running());
}

TEST_CASE(
    "files removed in a run are noticed: the attached go on, others are told, no second broker starts") {
  if (!is_isolated()) return;
  remove_all();
  ChildProcess broker({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(broker.read_until("ready", 10s));
  ChildProcess reader({ISOBAR_IPC_PEER, "read", "1000"});  // five seconds
  std::this_thread::sleep_for(1s);
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
    std::filesystem::remove(entry.path());
  CHECK(broker.read_until("missing: /dev/shm/iceoryx_mgmt, /dev/shm/root", 2s));
  ChildProcess late({ISOBAR_IPC_PEER, "read", "1"});
  CHECK(late.read_until("isobard runs, but its shared memory /dev/shm/iceoryx_mgmt was removed", 10s));
  CHECK(late.wait(5s) == 69);
  ChildProcess second({ISOBAR_IPC_PEER, "broker"});
  CHECK(second.read_until("another isobard is running on this machine, of user root", 5s));
  CHECK(second.wait(5s) == 69);
  CHECK(reader.wait(20s) == 0);
}

}  // namespace isobar::test::test_other_users
