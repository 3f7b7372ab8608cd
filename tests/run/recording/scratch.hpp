// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "run/recording/recording_reader.hpp"

namespace isobar::test {

/// Temporary folder, removed at the end of the test.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "isobar-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void write(const std::string& file, const std::string& content) const {
    std::ofstream(path_ / file, std::ios::binary) << content;
  }

 private:
  std::filesystem::path path_;
};

inline const recording::Count* find_count(const std::vector<recording::Count>& counts,
                                          const std::string& name) {
  for (const auto& count : counts) {
    if (count.name == name) {
      return &count;
    }
  }
  return nullptr;
}

inline std::uint64_t count_of(const recording::RecordingReader& reader, const std::string& name) {
  const auto counts = reader.counts();
  const auto* count = find_count(counts, name);
  return count == nullptr ? 0 : count->count;
}

}  // namespace isobar::test
