// SPDX-License-Identifier: BSD-3-Clause
// Architecture rules that a compiler does not check: which folder may include which, which files may include
// a library, and how long a file may be.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace isobar::test::test_architecture {

namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string>;

struct Source {
  std::string path;  ///< below the source folder, "core/map/grid.hpp"
  std::vector<std::string> lines;
  std::vector<std::string> own_includes;      ///< "core/map/grid.hpp"
  std::vector<std::string> foreign_includes;  ///< "Eigen/Core"
};

Source read_source(const fs::path& file) {
  Source source{fs::relative(file, ISOBAR_SOURCE_DIR).string(), {}, {}, {}};
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    source.lines.push_back(line);
    if (!line.starts_with("#include")) continue;
    const auto begin = line.find_first_of("<\"");
    const auto end = line.find_first_of(">\"", begin + 1);
    auto& includes = line[begin] == '<' ? source.foreign_includes : source.own_includes;
    includes.push_back(line.substr(begin + 1, end - begin - 1));
  }
  return source;
}

std::vector<Source> sources_below(const std::string& folder) {
  std::vector<Source> sources;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ISOBAR_SOURCE_DIR) / folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".hpp" || extension == ".cpp") sources.push_back(read_source(entry.path()));
  }
  REQUIRE_MESSAGE(!sources.empty(), folder << " holds no source file");
  return sources;
}

/// The part of a path before its first (depth 1) or second (depth 2) slash.
std::string folder_of(const std::string& path, int depth = 1) {
  std::size_t end = path.find('/');
  if (depth == 2 && end != std::string::npos) end = path.find('/', end + 1);
  return path.substr(0, end);
}

bool starts_with_any(const std::string& text, const Names& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& p) { return text.starts_with(p); });
}

/// Top-level folders and the ones that each may include besides itself. An arrow only points down this list.
const std::map<std::string, Names> kMayInclude{
    {"core", {}},
    {"drivers", {"core"}},
    {"run", {"core"}},
    {"simulation", {"core", "drivers", "run"}},
    {"ipc", {"core", "drivers"}},
    {"config", {"core", "drivers", "run", "ipc"}},
    {"daemon", {"core", "drivers", "run", "ipc", "config"}},
    {"tools", {"core", "drivers", "run", "simulation", "ipc", "config", "daemon"}},
};

/// The same inside core. Headers of core itself (samples, estimates, errors …) may be included anywhere.
const std::map<std::string, Names> kMayIncludeInCore{
    {"core/statistics", {}},
    {"core/time", {}},
    {"core/altitude", {}},
    {"core/calibration", {"core/altitude", "core/statistics"}},
    {"core/contradictions", {}},
    {"core/graph", {}},
    {"core/map", {}},
    {"core/prior", {"core/altitude"}},
    {"core/mounts", {"core/prior"}},
    {"core/registration", {"core/altitude", "core/map", "core/mounts", "core/prior"}},
    {"core/floors", {"core/map"}},
    {"core/place", {"core/map", "core/registration"}},
    {"core/loops", {"core/graph", "core/map", "core/registration"}},
    {"core/merge", {"core/graph", "core/loops", "core/map", "core/place", "core/registration"}},
};

/// Libraries and the places that may include them. A library that is not listed may be included anywhere.
const std::map<std::string, Names> kNamedOnlyBy{
    {"spdlog/", {"daemon/"}},        {"iceoryx", {"ipc/iceoryx/"}},
    {"dds/", {"ipc/dds/"}},          {"CLI/", {"daemon/", "tools/"}},
    {"nanoflann", {"core/map/"}},    {"pcap", {"run/recording/"}},
    {"toml++", {"config/", "run/"}}, {"systemd/", {"daemon/"}},
    {"httplib.h", {"tools/web/"}},   {"openssl/", {"config/checksum", "ipc/keys/"}},
};

/// Standard headers that only code with threads, I/O or a clock needs: none of them in core.
const Names kNotInCore{"thread",   "mutex",  "shared_mutex", "condition_variable", "future", "iostream",
                       "fstream",  "cstdio", "chrono",       "filesystem",         "ctime",  "unistd.h",
                       "syslog.h", "sys/",   "stop_token",   "semaphore"};

}  // namespace

TEST_CASE("an include points from a folder to itself or to a folder below it") {
  for (const auto& [folder, below] : kMayInclude) {
    for (const Source& source : sources_below(folder)) {
      for (const std::string& include : source.own_includes) {
        const std::string target = folder_of(include);
        CHECK_MESSAGE((target == folder || below.contains(target)), source.path << " includes " << include);
      }
    }
  }
}

TEST_CASE("inside core the estimator includes no fits or studies, and a stage includes no later stage") {
  for (const auto& [folder, below] : kMayIncludeInCore) {
    for (const Source& source : sources_below(folder)) {
      for (const std::string& include : source.own_includes) {
        const std::string target = folder_of(include, 2);
        const bool is_common = fs::path(target).has_extension();
        CHECK_MESSAGE((is_common || target == folder || below.contains(target)),
                      source.path << " includes " << include);
      }
    }
  }
}

TEST_CASE("core has no threads, no I/O, no logging and no clock, and of libraries only Eigen and nanoflann") {
  for (const Source& source : sources_below("core")) {
    for (const std::string& include : source.foreign_includes) {
      CHECK_MESSAGE(!starts_with_any(include, kNotInCore), source.path << " includes " << include);
      const bool is_standard = include.find_first_of("/.") == std::string::npos || include == "emmintrin.h" ||
                               include == "immintrin.h" || include == "smmintrin.h";
      CHECK_MESSAGE((is_standard || include.starts_with("Eigen/") || include == "nanoflann.hpp"),
                    source.path << " includes " << include);
    }
  }
}

TEST_CASE("a listed library is included only by its permitted places") {
  for (const auto& [folder, below] : kMayInclude) {
    for (const Source& source : sources_below(folder)) {
      for (const std::string& include : source.foreign_includes) {
        for (const auto& [library, places] : kNamedOnlyBy) {
          if (!include.starts_with(library)) continue;
          CHECK_MESSAGE(starts_with_any(source.path, places), source.path << " includes " << include);
        }
      }
    }
  }
}

TEST_CASE("the estimator does not include DDS: a fault in its parser cannot stop isobard") {
  for (const Source& source : sources_below("daemon")) {
    if (source.path.starts_with("daemon/bridge/")) continue;
    for (const std::string& include : source.own_includes) {
      CHECK_MESSAGE(!include.starts_with("ipc/dds/"), source.path << " includes " << include);
      CHECK_MESSAGE(!include.starts_with("daemon/bridge/"), source.path << " includes " << include);
    }
  }
}

TEST_CASE("a source file has at most 300 lines, and its licence in the first one") {
  constexpr std::size_t kMostLines = 300;
  for (const auto& [folder, below] : kMayInclude) {
    for (const Source& source : sources_below(folder)) {
      CHECK_MESSAGE(source.lines.size() <= kMostLines,
                    source.path << " has " << source.lines.size() << " lines");
      REQUIRE_MESSAGE(!source.lines.empty(), source.path << " is empty");
      CHECK_MESSAGE(source.lines.front() == "// SPDX-License-Identifier: BSD-3-Clause", source.path);
    }
  }
}

}  // namespace isobar::test::test_architecture
