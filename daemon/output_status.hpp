// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace isobar {

/// Status of the output thread.
struct OutputStatus {
  bool present = false;
  bool failing = false;             ///< the last attempt to write failed; the next one is half a second later
  std::array<char, 120> reason{};   ///< of the last failure
  std::uint64_t poses = 0;          ///< taken
  std::uint64_t dropped_lines = 0;  ///< poses lost because the disk refused for too long
};

}  // namespace isobar
