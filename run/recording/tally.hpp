// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace isobar::recording {

/// Counter with the message of the first occurrence; the others cost no text formatting.
struct Tally {
  std::uint64_t count = 0;
  std::string first_message;

  /// Counts an occurrence.
  /// @param describe std::string(): the message, called for the first occurrence only
  template <typename Describe>
  void add(const Describe& describe) {
    if (count++ == 0) {
      first_message = describe();
    }
  }
};

}  // namespace isobar::recording
