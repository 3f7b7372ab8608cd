// SPDX-License-Identifier: BSD-3-Clause
#include "config/nearest_key.hpp"

#include <algorithm>

#include "core/nearest_word.hpp"

namespace isobar {

std::string nearest_key(const std::vector<Setting>& settings, const std::string& key) {
  constexpr std::size_t kLongestKey = 80;  // bounds the time, which is the product of both lengths
  if (key.size() > kLongestKey) {
    return {};
  }
  const bool has_section = key.find('.') != std::string::npos;
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(3, key.size() / 3);
  for (const Setting& setting : settings) {
    std::size_t distance = edit_distance(key, setting.key);
    if (!has_section) {
      distance = std::min(distance, edit_distance(key, setting.name()));
    }
    if (distance < best_distance) {
      best_distance = distance;
      best = setting.key;
    }
  }
  return best;
}

}  // namespace isobar
