// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace isobar::recording {

/// How often something was met, and the words for the first time. Later times cost no text.
struct Tally {
  std::uint64_t count = 0;
  std::string first_message;

  /// describe: called for the first time only, returns the message.
  template <typename Describe>
  void add(const Describe& describe) {
    if (count++ == 0) {
      first_message = describe();
    }
  }
};

}  // namespace isobar::recording
