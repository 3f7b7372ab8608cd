// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "core/name_table.hpp"
#include "drivers/encoder/kinematics.hpp"

namespace isobar::encoder {

inline constexpr NameTable<Drive, 3> kDriveNames{{{
    {Drive::kDifferential, "differential"},
    {Drive::kSkidSteer, "skid-steer"},
    {Drive::kTracked, "tracked"},
}}};

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
  EncoderLines left;           ///< or front left
  EncoderLines right;          ///< or front right
  EncoderLines rear_left;      ///< optional
  EncoderLines rear_right;     ///< optional
  bool left_reversed = false;  ///< forward, B leads A: an encoder mounted the other way round
  bool right_reversed = false;
  Geometry geometry;
  int rate_hz = 50;  ///< samples per second

  /// In the order of the encoders' indices, even ones left; lines of a reversed side exchanged.
  [[nodiscard]] std::array<EncoderLines, kMaxEncoders> encoders() const noexcept {
    std::array<EncoderLines, kMaxEncoders> all{left, right, rear_left, rear_right};
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % 2 == 0 ? left_reversed : right_reversed) std::swap(all[i].a, all[i].b);
    }
    return all;
  }
};

/// Rule that settings break, and the name of the setting; rule nullptr: none.
struct BrokenRule {
  const char* rule = nullptr;
  const char* name = "";
};

/// Each side has an encoder, each encoder both lines, and no line is used twice.
[[nodiscard]] inline BrokenRule broken_rule(const Settings& settings) noexcept {
  constexpr std::array kNames{"left_a",      "left_b",      "right_a",      "right_b",
                              "rear_left_a", "rear_left_b", "rear_right_a", "rear_right_b"};
  const std::array lines{settings.left.a,       settings.left.b,      settings.right.a,
                         settings.right.b,      settings.rear_left.a, settings.rear_left.b,
                         settings.rear_right.a, settings.rear_right.b};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool has_partner = lines[i % 2 == 0 ? i + 1 : i - 1] >= 0;
    if (lines[i] < 0 && i < 4)
      return {"must name a line: each side needs an encoder with two lines", kNames[i]};
    if (lines[i] < 0 && has_partner) return {"must name a line: an encoder has two", kNames[i]};
    for (std::size_t before = 0; before < i; ++before) {
      if (lines[i] >= 0 && lines[i] == lines[before]) return {"must differ from every other line", kNames[i]};
    }
  }
  return {};
}

}  // namespace isobar::encoder
