// SPDX-License-Identifier: BSD-3-Clause
// Folders that the service manager has made for this service.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace isobar {

/// First folder of a variable of systemd.exec(5): STATE_DIRECTORY, RUNTIME_DIRECTORY. Empty without one, as for
/// a program that a person starts.
inline std::filesystem::path service_folder(const char* variable) {
  const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets variables
  if (value == nullptr) return {};
  const std::string_view folders(value);
  return folders.substr(0, folders.find(':'));
}

}  // namespace isobar
