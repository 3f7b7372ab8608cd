// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/lock_table.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace isobar::ipc {

std::optional<HeldLock> find_lock(const std::string& path, bool is_flock) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  std::array<char, 64> place{};
  std::snprintf(place.data(), place.size(), "%02x:%02x:%llu", major(status.st_dev), minor(status.st_dev),
                static_cast<unsigned long long>(status.st_ino));
  std::ifstream table("/proc/locks");
  for (std::string line; std::getline(table, line);) {
    // 1: OFDLCK ADVISORY  WRITE -1 00:1d:1234 0 0
    std::istringstream words(line);
    std::string number;
    std::string type;
    std::string kind;
    std::string access;
    std::string file;
    HeldLock held;
    words >> number >> type;
    if (type == "->") continue;  // a process that waits
    words >> kind >> access >> held.pid >> file;
    if (file == place.data() && (type == "FLOCK") == is_flock) return held;
  }
  return std::nullopt;
}

}  // namespace isobar::ipc
