// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"

namespace isobar::tools {

/// A folder that is filled, and that is as before where that fails: gone, or empty.
class NewFolder {
 public:
  /// @throws UsageError when it exists and is not empty; DataError when it cannot be made
  explicit NewFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    existed_ = std::filesystem::exists(folder_, error);
    if (existed_ &&
        (!std::filesystem::is_directory(folder_, error) || !std::filesystem::is_empty(folder_, error))) {
      throw UsageError("--out: " + printable(folder_.string(), 200) +
                       " exists already; a recording is written to a new folder");
    }
    std::filesystem::create_directories(folder_, error);
    if (error) throw DataError(folder_.string() + ": cannot be made: " + error.message());
  }
  ~NewFolder() {
    std::error_code ignored;
    if (kept_) return;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
      std::filesystem::remove_all(entry.path(), ignored);
    }
    if (!existed_) std::filesystem::remove(folder_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  void keep() { kept_ = true; }

 private:
  std::filesystem::path folder_;
  bool existed_ = false;
  bool kept_ = false;
};

}  // namespace isobar::tools
