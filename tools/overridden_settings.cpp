// SPDX-License-Identifier: BSD-3-Clause
#include "tools/overridden_settings.hpp"

#include "config/settings_by_key.hpp"

namespace isobar::tools {

std::vector<std::string> overridden_settings(const LoadedConfig& loaded, const Config& used) {
  const auto wanted = settings_by_key(loaded.config);
  const auto taken = settings_by_key(used);
  std::vector<std::string> sentences;
  for (const auto& [key, origin] : loaded.origins) {
    const auto before = wanted.find(key);
    const auto after = taken.find(key);
    if (before == wanted.end() || after == taken.end() || before->second == after->second) continue;
    sentences.push_back(origin.file + ":" + std::to_string(origin.line) + ": " + key + " = " +
                        before->second + " is not used: the recording has " + after->second);
  }
  return sentences;
}

}  // namespace isobar::tools
