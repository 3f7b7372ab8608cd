// SPDX-License-Identifier: BSD-3-Clause
// Rules of the house that no compiler checks: which folder may include which.
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

/// Headers of the system or of libraries that a folder must not name.
void check_none(const std::string& folder, const std::vector<std::string>& forbidden) {
  const auto includes = includes_below(folder);
  REQUIRE(includes.size() > 5);
  for (const Include& include : includes) {
    CHECK_MESSAGE(!starts_with_any(include.what, forbidden), include.file << " includes " << include.what);
  }
}

/// Of the folders of this repository `folder` names only itself and these.
void check_only(const std::string& folder, std::vector<std::string> allowed) {
  const std::vector<std::string> folders = {"core/",       "drivers/", "run/",   "ipc/",  "config/",
                                            "simulation/", "daemon/",  "tools/", "tests/"};
  allowed.push_back(folder + "/");
  const auto includes = includes_below(folder);
  REQUIRE(includes.size() > 5);
  for (const Include& include : includes) {
    const bool is_ours = starts_with_any(include.what, folders);
    CHECK_MESSAGE((!is_ours || starts_with_any(include.what, allowed)),
                  include.file << " includes " << include.what);
  }
}

bool is_below(const Include& include, const std::string& part) {
  return include.file.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "dependencies point one way: core, then drivers, ipc and run, then config, then daemon, then tools") {
  check_only("core", {});
  check_only("drivers", {"core/"});
  check_only("ipc", {"core/", "drivers/"});
  check_only("run", {"core/", "drivers/"});
  check_only("config", {"core/", "drivers/", "ipc/", "run/"});
  check_only("daemon", {"core/", "drivers/", "ipc/", "run/", "config/"});
}

TEST_CASE("only tools and tests name the simulator, which knows neither the service nor its configuration") {
  check_only("simulation", {"core/", "drivers/", "run/"});
  check_only("tools", {"core/", "drivers/", "ipc/", "run/", "config/", "daemon/", "simulation/"});
}

TEST_CASE("the estimator does not include what only the tools calibrate and fit with") {
  for (const Include& include : includes_below("core")) {
    if (is_below(include, "/core/calibration/")) continue;
    CHECK_MESSAGE(!starts_with_any(include.what, {"core/calibration/"}),
                  include.file << " includes " << include.what);
  }
}

TEST_CASE("core has no threads, no I/O, no logging and no clock") {
  check_none("core",
             {"thread", "mutex", "condition_variable", "future", "iostream", "fstream", "cstdio", "chrono",
              "filesystem", "unistd.h", "sys/", "spdlog", "iceoryx", "dds/", "toml++", "CLI/"});
}

TEST_CASE("only daemon and tools log or parse a command line") {
  for (const char* folder : {"drivers", "ipc", "run", "config", "simulation"}) {
    CAPTURE(folder);
    check_none(folder, {"spdlog/spdlog", "spdlog/sinks", "CLI/"});
  }
}

TEST_CASE("isobard includes no DDS; ipc/dds and the bridge do, and config knows the settings only") {
  for (const char* folder : {"core", "drivers", "run", "config", "simulation"}) {
    CAPTURE(folder);
    check_none(folder, {"dds/", "ipc/dds/"});
  }
  for (const char* folder : {"daemon", "ipc"}) {
    for (const Include& include : includes_below(folder)) {
      if (is_below(include, "/daemon/bridge/") || is_below(include, "/ipc/dds/")) continue;
      CHECK_MESSAGE(!starts_with_any(include.what, {"dds/", "ipc/dds/"}),
                    include.file << " includes " << include.what);
    }
  }
}

TEST_CASE("one folder, ipc/iceoryx, includes iceoryx") {
  for (const char* folder : {"core", "drivers", "ipc", "run", "config", "simulation", "daemon", "tools"}) {
    for (const Include& include : includes_below(folder)) {
      if (is_below(include, "/ipc/iceoryx/")) continue;
      CHECK_MESSAGE(!starts_with_any(include.what, {"iceoryx", "ipc/iceoryx/"}),
                    include.file << " includes " << include.what);
    }
  }
}

}  // namespace isobar::test::test_architecture
