// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace isobar {

/// Elements of a list in a text, without the spaces around them. "a, b" has two; an empty text has none; "a,"
/// has two, the second empty.
/// @param separators each of these characters separates two elements
[[nodiscard]] inline std::vector<std::string> split_list(std::string_view text,
                                                         std::string_view separators = ",") {
  std::vector<std::string> elements;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(separators);
    std::string_view element = text.substr(0, end);
    element.remove_prefix(std::min(element.find_first_not_of(' '), element.size()));
    element = element.substr(0, element.find_last_not_of(' ') + 1);
    elements.emplace_back(element);
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
    if (text.empty()) elements.emplace_back();
  }
  return elements;
}

}  // namespace isobar
