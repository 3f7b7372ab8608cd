// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_thread_umask {

TEST_CASE("threads of a library that set the mask and set it back change no folder of the program") {
  const TemporaryFolder folder;
  ::umask(S_IWGRP | S_IWOTH);
  std::atomic<bool> stopped{false};
  std::vector<std::thread> threads;
  threads.reserve(3);
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&stopped] {
      while (!stopped) {
        const mode_t before = ::umask(S_IXUSR | S_IXGRP | S_IRWXO);
        ::umask(before);
      }
    });
  }
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto made = folder.path() / std::to_string(i);
    REQUIRE(std::filesystem::create_directory(made));
    struct stat status {};
    REQUIRE(::stat(made.c_str(), &status) == 0);
    wrong += (status.st_mode & 0777U) == 0755U ? 0 : 1;
  }
  stopped = true;
  CHECK(wrong == 0);
  for (std::thread& thread : threads) thread.join();
  CHECK(::umask(S_IWGRP | S_IWOTH) == (S_IWGRP | S_IWOTH));
}

}  // namespace isobar::test::test_thread_umask
