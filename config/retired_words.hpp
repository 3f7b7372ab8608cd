// SPDX-License-Identifier: BSD-3-Clause
// Keys and values of earlier versions, with what replaces them: an upgrade must say the remedy.
#pragma once

#include <array>
#include <string_view>

namespace isobar {

struct RetiredWord {
  std::string_view key;
  std::string_view value;  ///< empty: the whole key is retired
  std::string_view remedy;
};

inline constexpr auto kRetiredWords = std::to_array<RetiredWord>({
    {"dds.receive_sensors", "", "replaced by imu.source = \"dds\" and wheel.source = \"dds\""},
    {"imu.source", "input", "\"input\" is called \"datagram\""},
    {"barometer.source", "input", "\"input\" is called \"datagram\""},
});

/// What replaces a key, or a value of it; empty: nothing of that name was retired.
[[nodiscard]] constexpr std::string_view retired_remedy(std::string_view key, std::string_view value = {}) {
  for (const RetiredWord& word : kRetiredWords) {
    if (word.key == key && word.value == value) return word.remedy;
  }
  return {};
}

}  // namespace isobar
