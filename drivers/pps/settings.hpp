// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace isobar::pps {

/// GPIO line with a pulse a second.
struct Settings {
  std::string chip = "/dev/gpiochip0";
  int line = -1;               ///< of the chip; -1: none
  double max_offset_ms = 1.0;  ///< of the system clock against the second, beyond which it is a warning
  [[nodiscard]] bool present() const { return line >= 0; }
};

}  // namespace isobar::pps
