// SPDX-License-Identifier: BSD-3-Clause
#include "config/nearest_key.hpp"

#include <algorithm>
#include <string_view>

namespace isobar {
namespace {

/// Levenshtein distance: number of letters to change, add or drop.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

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
