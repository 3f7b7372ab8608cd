// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "drivers/encoder/kinematics.hpp"

namespace isobar::encoder {

/// Lines of one encoder, offsets on the chip; negative: this wheel has no encoder. Lines that are exchanged
/// turn its direction.
struct EncoderLines {
  int a = -1;
  int b = -1;
  [[nodiscard]] bool present() const noexcept { return a >= 0 && b >= 0; }
};

inline constexpr std::size_t kMaxEncoders = 4;

/// Quadrature encoders of a robot's wheels on the lines of a GPIO chip.
struct Settings {
  std::string chip = "/dev/gpiochip0";
  EncoderLines left;        ///< or front left
  EncoderLines right;       ///< or front right
  EncoderLines rear_left;   ///< optional
  EncoderLines rear_right;  ///< optional
  Geometry geometry;
  int rate_hz = 50;  ///< samples per second

  /// In the order of the encoders' indices; even ones are left.
  [[nodiscard]] std::array<EncoderLines, kMaxEncoders> encoders() const noexcept {
    return {left, right, rear_left, rear_right};
  }
};

}  // namespace isobar::encoder
