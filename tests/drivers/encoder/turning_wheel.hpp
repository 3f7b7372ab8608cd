// SPDX-License-Identifier: BSD-3-Clause
// An encoder disc: edges of its lines as it turns. Written from the picture of the two tracks, without the
// decoder.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/encoder/quadrature.hpp"

namespace isobar::encoder {

/// A disc at a whole number of quarter periods. Track A is high in quarters 1 and 2 of 4, track B in 2 and 3.
class TurningWheel {
 public:
  explicit TurningWheel(std::uint8_t encoder = 0) : encoder_(encoder) {}
  [[nodiscard]] bool a() const { return quarter() == 1 || quarter() == 2; }
  [[nodiscard]] bool b() const { return quarter() == 2 || quarter() == 3; }
  [[nodiscard]] std::int64_t position() const { return position_; }

  /// Turns by one quarter.
  /// @return the edge
  Edge turn(bool forward, std::int64_t stamp_ns) {
    const bool before_a = a();
    position_ += forward ? 1 : -1;
    const bool is_a = a() != before_a;
    return {stamp_ns, encoder_, is_a ? Line::kA : Line::kB, is_a ? a() : b()};
  }

 private:
  [[nodiscard]] std::int64_t quarter() const { return ((position_ % 4) + 4) % 4; }
  std::int64_t position_ = 0;
  std::uint8_t encoder_;
};

}  // namespace isobar::encoder
