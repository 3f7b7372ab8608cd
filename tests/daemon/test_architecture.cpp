// SPDX-License-Identifier: BSD-3-Clause
// The rules of the house that a compiler does not check: who may include what.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace isobar::test::test_architecture {

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;
  std::string what;
};

std::vector<Include> includes_below(const std::string& folder) {
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ISOBAR_SOURCE_DIR) / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.rfind("#include", 0) != 0) continue;
      const auto begin = line.find_first_of("<\"");
      const auto end = line.find_first_of(">\"", begin + 1);
      includes.push_back({entry.path().string(), line.substr(begin + 1, end - begin - 1)});
    }
  }
  return includes;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes) {
    if (text.rfind(prefix, 0) == 0) return true;
  }
  return false;
}

void check_none(const std::string& folder, const std::vector<std::string>& forbidden) {
  const auto includes = includes_below(folder);
  REQUIRE(includes.size() > 10);
  for (const Include& include : includes) {
    CHECK_MESSAGE(!starts_with_any(include.what, forbidden), include.file << " includes " << include.what);
  }
}

}  // namespace

TEST_CASE("core has no threads, no I/O, no logging, no clock, and knows nothing of who uses it") {
  check_none("core",
             {"thread", "mutex",      "condition_variable", "future", "iostream", "fstream", "cstdio",
              "chrono", "filesystem", "unistd.h",           "sys/",   "spdlog",   "iceoryx", "dds/",
              "toml++", "CLI/",       "drivers/",           "ipc/",   "config/",  "daemon/", "tools/"});
}

TEST_CASE("drivers build on core alone") {
  check_none("drivers", {"spdlog", "iceoryx", "dds/", "CLI/", "ipc/", "config/", "daemon/", "tools/"});
}

TEST_CASE("the estimator names no DDS, and one pair of files names iceoryx") {
  check_none("daemon", {"iceoryx"});
  for (const Include& include : includes_below("daemon")) {
    if (include.file.find("/daemon/bridge/") != std::string::npos) continue;
    CHECK_MESSAGE(!starts_with_any(include.what, {"dds/", "ipc/dds/"}),
                  include.file << " includes " << include.what);
  }
  for (const Include& include : includes_below("ipc")) {
    if (include.file.find("/ipc/shared_memory.cpp") != std::string::npos) continue;
    CHECK_MESSAGE(!starts_with_any(include.what, {"iceoryx"}), include.file << " includes " << include.what);
  }
}

}  // namespace isobar::test::test_architecture
