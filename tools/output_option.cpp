// SPDX-License-Identifier: BSD-3-Clause
#include "tools/output_option.hpp"

#include <algorithm>
#include <cctype>

namespace isobar::tools {

CLI::Validator written_as(const std::vector<std::string>& endings) {
  const auto check = [endings](const std::string& file) -> std::string {
    std::string ending = std::filesystem::path(file).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return {};
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

}  // namespace isobar::tools
