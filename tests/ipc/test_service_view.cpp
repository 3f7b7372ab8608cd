// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/errors.hpp"
#include "ipc/service_view.hpp"

namespace isobar::test::test_service_view {

namespace fs = std::filesystem;

namespace {

constexpr const char* kUser = "nobody";  // stands for the services' user

/// Folders as the units have them, with the lock file of an isobard that has run.
ipc::ServiceFolders make_folders() {
  char name[] = "/var/tmp/service_view_XXXXXX";
  const fs::path root = ::mkdtemp(name);
  const passwd* user = ::getpwnam(kUser);
  for (const char* folder : {"shm", "tmp"}) {
    fs::create_directory(root / folder);
    REQUIRE(::chown((root / folder).c_str(), user->pw_uid, user->pw_gid) == 0);
  }
  REQUIRE(::chown(root.c_str(), user->pw_uid, user->pw_gid) == 0);
  REQUIRE(::chmod(root.c_str(), 0750) == 0);
  std::ofstream(root / "shm" / "isobar.lock") << "";
  std::ofstream(root / "tmp" / "roudi") << "";
  return {(root / "shm").string(), (root / "tmp").string(), kUser};
}

/// Exit code of a process of its own, which the view never leaves.
int in_child(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 99;
    try {
      code = body();
    } catch (const ServiceError&) {
      code = 69;
    }
    std::_Exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool sees_the_service() { return fs::exists("/dev/shm/isobar.lock") && fs::exists("/tmp/roudi"); }

int enter_and_look(const ipc::ServiceFolders& folders) {
  ipc::enter_service_view(folders);
  return sees_the_service() ? 0 : 1;
}

bool is_isolated_root() { return ::geteuid() == 0 && std::getenv("ISOBAR_ISOLATED") != nullptr; }

}  // namespace

TEST_CASE("root enters the services' view as their user; this process stays where it is") {
  if (!is_isolated_root()) return;
  const auto folders = make_folders();
  CHECK(in_child([&] { return enter_and_look(folders); }) == 0);
  CHECK(in_child([&] {
          ipc::enter_service_view(folders);
          return ::geteuid() == ::getpwnam(kUser)->pw_uid ? 0 : 1;
        }) == 0);
  CHECK_FALSE(sees_the_service());
  fs::remove_all(fs::path(folders.sockets).parent_path());
}

TEST_CASE("a second call inside the view changes nothing") {
  if (!is_isolated_root()) return;
  const auto folders = make_folders();
  CHECK(in_child([&] {
          ipc::enter_service_view(folders);
          return enter_and_look(folders);
        }) == 0);
  fs::remove_all(fs::path(folders.sockets).parent_path());
}

TEST_CASE("a member with the group as effective group enters; another user gets an error with the remedy") {
  if (!is_isolated_root()) return;
  const auto folders = make_folders();
  const passwd* user = ::getpwnam(kUser);
  CHECK(in_child([&] {
          if (::setresgid(user->pw_gid, user->pw_gid, user->pw_gid) != 0 ||
              ::setresuid(12345, 12345, 12345) != 0) {
            return 2;
          }
          // A change of users makes /proc/self root's; a login shell's programs have it.
          ::prctl(PR_SET_DUMPABLE, 1);
          return enter_and_look(folders);
        }) == 0);
  CHECK(in_child([&] {
          if (::setgroups(0, nullptr) != 0 || ::setresgid(12345, 12345, 12345) != 0 ||
              ::setresuid(12345, 12345, 12345) != 0) {
            return 2;
          }
          return enter_and_look(folders);
        }) == 69);
  fs::remove_all(fs::path(folders.sockets).parent_path());
}

TEST_CASE("without a service's shared memory nothing changes") {
  const ipc::ServiceFolders none{"/var/tmp/no-such-folder/shm", "/var/tmp/no-such-folder/tmp", kUser};
  CHECK(in_child([&] {
          ipc::enter_service_view(none);
          return 7;
        }) == 7);
}

}  // namespace isobar::test::test_service_view
