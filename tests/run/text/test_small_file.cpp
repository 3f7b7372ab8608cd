// SPDX-License-Identifier: BSD-3-Clause
// Files that are read whole: regular and of bounded size.
#include "run/text/small_file.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_small_file {

namespace {

std::string refusal(const std::filesystem::path& file) { return text::read_small_file(file, 1024).refusal; }

}  // namespace

TEST_CASE("a file up to the limit is read, byte for byte") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a";
  std::ofstream(file, std::ios::binary) << std::string(1024, 'x');
  CHECK(text::read_small_file(file, 1024).content == std::string(1024, 'x'));
  std::ofstream(file, std::ios::binary) << std::string("a\0b", 3);
  CHECK(text::read_small_file(file, 1024).content == std::string("a\0b", 3));
}

TEST_CASE("what is no regular file of bounded size is refused at once") {
  const TemporaryFolder folder;
  const auto fifo = folder.path() / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  CHECK(refusal(fifo).find("no regular file") != std::string::npos);
  CHECK(refusal("/dev/zero").find("no regular file") != std::string::npos);
  CHECK(refusal("/dev/urandom").find("no regular file") != std::string::npos);
  CHECK(refusal(folder.path()).find("is a folder") != std::string::npos);
  CHECK(refusal(folder.path() / "none") == "no such file");
  const auto large = folder.path() / "large";
  std::ofstream(large, std::ios::binary) << std::string(1025, 'x');
  CHECK(refusal(large) == "is larger than 1 KiB, the largest size");
  CHECK(refusal("/proc/kallsyms") == "is larger than 1 KiB, the largest size");  // its size reads as 0
}

}  // namespace isobar::test::test_small_file
