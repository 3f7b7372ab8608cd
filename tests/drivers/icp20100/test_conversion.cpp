// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cstdint>

#include "drivers/icp20100/conversion.hpp"

namespace isobar::test::test_icp20100_conversion {

using namespace isobar::icp20100;

TEST_CASE("results are 20 bit two's complement, lowest byte first, around 70 kPa and 25 degrees C") {
  // The ends of the data sheet's formula: 2^17 is 110 kPa, -2^17 is 30 kPa; 2^18 is 90 degrees, -2^18 is -40.
  const std::array<std::uint8_t, kResultBytes> high{0x00, 0x00, 0x02, 0x00, 0x00, 0x04};
  CHECK(convert(decode_result(high)).pressure_pa == 110e3);
  CHECK(convert(decode_result(high)).temperature_c == 90.0);
  const std::array<std::uint8_t, kResultBytes> low{0x00, 0x00, 0x0E, 0x00, 0x00, 0x0C};
  CHECK(convert(decode_result(low)).pressure_pa == 30e3);
  CHECK(convert(decode_result(low)).temperature_c == -40.0);
  // The upper half of each third byte has no meaning.
  const std::array<std::uint8_t, kResultBytes> dirty{0x00, 0x00, 0xFE, 0x00, 0x00, 0xAC};
  CHECK(convert(decode_result(dirty)).pressure_pa == 30e3);
  CHECK(convert(decode_result(dirty)).temperature_c == -40.0);
}

TEST_CASE("an empty FIFO and results outside the operating range name the rule") {
  const RawResult sound{100'000, 0};
  CHECK(implausibility(sound, convert(sound)) == nullptr);
  const RawResult empty{0, 0};
  CHECK(implausibility(empty, convert(empty)) != nullptr);
  const RawResult hot{100'000, 262'144};  // 90 degrees
  CHECK(implausibility(hot, convert(hot)) != nullptr);
  const RawResult thin{-131'073, 1};
  CHECK(implausibility(thin, convert(thin)) != nullptr);
}

TEST_CASE("a filtered result counts for as much as its density of noise says") {
  for (const Mode& mode : kModes) {
    CHECK(&mode_of(mode.rate_hz) == &mode);
    // White noise spreads its variance over half of the rate, a filtered result over the bandwidth.
    CHECK(white_variance_pa2(mode) / (0.5 * mode.rate_hz) ==
          doctest::Approx(mode.noise_pa * mode.noise_pa / mode.bandwidth_hz));
  }
  CHECK(mode_of(7).rate_hz == 25);
}

}  // namespace isobar::test::test_icp20100_conversion
