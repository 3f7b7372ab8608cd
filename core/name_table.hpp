// SPDX-License-Identifier: BSD-3-Clause
// Table of an enumeration's names: the one spelling on every wire, and its reverse lookup.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isobar {

/// Names of the values of `Enum`, in their order of declaration. Names are string literals, so data() is
/// null-terminated.
template <typename Enum, std::size_t kCount>
struct NameTable {
  struct Entry {
    Enum value;
    std::string_view name;
  };
  std::array<Entry, kCount> entries;

  /// "unknown" for a value outside the enumeration, such as one from another process.
  [[nodiscard]] constexpr std::string_view name(Enum value) const {
    for (const Entry& entry : entries) {
      if (entry.value == value) return entry.name;
    }
    return "unknown";
  }

  /// Reverse lookup, exact and case-sensitive; nothing for any other word.
  [[nodiscard]] constexpr std::optional<Enum> value(std::string_view name) const {
    for (const Entry& entry : entries) {
      if (entry.name == name) return entry.value;
    }
    return std::nullopt;
  }

  /// All names, in order.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    names.reserve(kCount);
    for (const Entry& entry : entries) names.emplace_back(entry.name);
    return names;
  }

  /// All names in one text, "none, offset, A_p", for messages.
  [[nodiscard]] std::string joined() const {
    std::string text;
    for (const Entry& entry : entries) text += (text.empty() ? "" : ", ") + std::string(entry.name);
    return text;
  }
};

}  // namespace isobar
