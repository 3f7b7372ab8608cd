// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "drivers/bmp581/conversion.hpp"
#include "drivers/bmp581/settings.hpp"

namespace isobar::test::test_bmp581_conversion {

using namespace isobar::bmp581;

TEST_CASE("results are 24 bit in 1/64 Pa, and in two's complement 1/65536 degrees C, lowest byte first") {
  // 101325 Pa * 64 = 0x62F340; 25.5 degrees * 65536 = 0x198000.
  const std::array<std::uint8_t, kDataBytes> room{0x00, 0x80, 0x19, 0x40, 0xF3, 0x62};
  CHECK(convert(decode_result(room)).pressure_pa == 101'325.0);
  CHECK(convert(decode_result(room)).temperature_c == 25.5);
  // -10.25 degrees * 65536 = -0xA4000 = 0xF5C000.
  const std::array<std::uint8_t, kDataBytes> cold{0x00, 0xC0, 0xF5, 0x00, 0x00, 0x1E};
  CHECK(convert(decode_result(cold)).temperature_c == -10.25);
  CHECK(convert(decode_result(cold)).pressure_pa == 30'720.0);
}

TEST_CASE("empty registers and results outside the operating range name the rule") {
  const RawResult sound{static_cast<std::int32_t>(20.0 * 65'536.0), 96'000 * 64};
  CHECK(implausibility(sound, convert(sound)) == nullptr);
  RawResult empty = sound;
  empty.pressure = kNoResult;
  CHECK(implausibility(empty, {96'000.0, 20.0}) != nullptr);
  empty = sound;
  empty.temperature = static_cast<std::int32_t>(kNoResult);
  CHECK(implausibility(empty, {96'000.0, 20.0}) != nullptr);
  RawResult thin = sound;
  thin.pressure = 29'999 * 64;
  CHECK(implausibility(thin, convert(thin)) != nullptr);
  RawResult hot = sound;
  hot.temperature = static_cast<std::int32_t>(85.1 * 65'536.0);
  CHECK(implausibility(hot, convert(hot)) != nullptr);
}

TEST_CASE("more oversampling takes longer and is less noisy, by the data sheet's rates of continuous mode") {
  // Table 9: both measurements back to back.
  constexpr std::array<double, 8> kContinuousHz{498, 374, 255, 155, 87, 46, 24, 12};
  for (int i = 0; i < 8; ++i) {
    const int times = 1 << i;
    const double both_s = pressure_time_s(times) + temperature_time_s(times <= 16 ? 1 : times / 16);
    CHECK(both_s * kContinuousHz[static_cast<std::size_t>(i)] == doctest::Approx(1.0).epsilon(0.03));
    if (i > 0) CHECK(pressure_noise_pa(times) < pressure_noise_pa(times / 2));
  }
  CHECK(busy_time_s(Settings{}) < 1.0);
}

TEST_CASE("every rate has its code, and a rate that the chip has not becomes the slowest") {
  CHECK(rate_code(240) == 0x1C);
  CHECK(rate_code(160) == 0x04);
  CHECK(rate_code(50) == 0x0F);
  CHECK(rate_code(1) == 0x1C);
}

}  // namespace isobar::test::test_bmp581_conversion
