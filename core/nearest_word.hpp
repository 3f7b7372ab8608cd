// SPDX-License-Identifier: BSD-3-Clause
// Suggestion for a word that was typed wrong, by edit distance.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace isobar {

/// Levenshtein distance: number of letters to change, add or drop. Time: the product of both lengths.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
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

/// The known word that an unknown one probably means: fewest letters off, at most two, or a third of its letters
/// where these are more; empty if none is as close. Words over 80 letters, which nobody types, have none.
[[nodiscard]] inline std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  if (word.empty() || word.size() > 80) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(3, word.size() / 3 + 1);
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    // A short word differs from any other of its length by few letters.
    if (distance >= best_distance || distance >= candidate.size()) continue;
    best_distance = distance;
    best = candidate;
  }
  return best;
}

/// "; did you mean X?" for a message, or nothing.
[[nodiscard]] inline std::string did_you_mean(std::string_view word, const std::vector<std::string>& known,
                                              const std::string& prefix = {}) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? std::string() : "; did you mean " + prefix + nearest + "?";
}

}  // namespace isobar
