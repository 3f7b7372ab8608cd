// SPDX-License-Identifier: BSD-3-Clause
#include "tools/output_option.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "core/errors.hpp"

namespace isobar::tools {

namespace {

/// Why no file can be made there; empty: its folder is there.
std::string missing_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  std::error_code error;
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return {};
  return file.string() + ": there is no folder " + folder.string();
}

}  // namespace

CLI::Validator written_as(const std::vector<std::string>& endings) {
  const auto check = [endings](const std::string& file) -> std::string {
    std::string ending = std::filesystem::path(file).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return missing_folder_of(file);
    std::string all;
    for (const std::string& one : endings) all += (all.empty() ? "" : " or ") + one;
    return file + ": is written as " + all + ", and its name must end so";
  };
  return {check, "", ""};
}

std::filesystem::path beside(const std::filesystem::path& folder, const std::string& ending) {
  std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return path.string() + ending;
}

void require_path(const std::filesystem::path& path, const std::string& expected) {
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw DataError(path.string() + ": no such file or folder; expected is " + expected);
}

}  // namespace isobar::tools
