// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "drivers/bmp390/compensation.hpp"
#include "drivers/bmp390/settings.hpp"
#include "tests/drivers/bmp390/known_sensor.hpp"

namespace isobar::test::test_bmp390_compensation {

using namespace isobar::bmp390;

TEST_CASE("the coefficients of a known sensor are read from their 21 bytes and scaled") {
  const Coefficients c = decode_coefficients(isobar::bmp390::kKnownBytes);
  // Data sheet 8.4, by hand: T1 27427 / 2^-8, T2 18776 / 2^30, T3 -10 / 2^48.
  CHECK(c.t[0] == 27'427.0 * 256.0);
  CHECK(c.t[1] == 18'776.0 / 1'073'741'824.0);
  CHECK(c.t[2] == -10.0 / 281'474'976'710'656.0);
  CHECK(c.p[0] == (-164.0 - 16'384.0) / 1'048'576.0);
  CHECK(c.p[4] == 25'578.0 * 8.0);
  CHECK(c.p[5] == 31'086.0 / 64.0);
  CHECK(c.p[10] == -60.0 / std::pow(2.0, 65));
}

TEST_CASE("a known sensor's result gives the published pressure and temperature") {
  const Compensated value = compensate(decode_coefficients(isobar::bmp390::kKnownBytes),
                                       decode_result(isobar::bmp390::kKnownResult));
  CHECK(std::abs(value.pressure_pa - isobar::bmp390::kKnownPressurePa) < 1e-6);
  CHECK(std::abs(value.temperature_c - isobar::bmp390::kKnownTemperatureC) < 1e-9);
}

TEST_CASE("the checksum is CRC-8 with polynomial 0x1D, and finds every flipped bit") {
  // The checksum itself is compared with the chip model's, a polynomial division, in test_sensor.cpp.
  const std::uint8_t crc = coefficient_crc(isobar::bmp390::kKnownBytes);
  CHECK(implausibility(isobar::bmp390::kKnownBytes, crc) == nullptr);
  for (std::size_t bit = 0; bit < 8 * kCoefficientBytes; ++bit) {
    CoefficientBytes flipped = isobar::bmp390::kKnownBytes;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    CHECK(implausibility(flipped, crc) != nullptr);
  }
  CoefficientBytes level{};
  CHECK(implausibility(level, coefficient_crc(level)) != nullptr);  // a bus held low
}

TEST_CASE("every input gives finite numbers, and implausible results name the rule") {
  std::mt19937 random(7);
  std::size_t plausible = 0;
  for (int i = 0; i < 50'000; ++i) {
    CoefficientBytes bytes = isobar::bmp390::kKnownBytes;
    for (int flips = i % 4; flips > 0; --flips)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    std::array<std::uint8_t, kDataBytes> result{};
    for (auto& byte : result) byte = static_cast<std::uint8_t>(random());
    const RawResult raw = decode_result(result);
    const Compensated value = compensate(decode_coefficients(bytes), raw);
    REQUIRE(std::isfinite(value.pressure_pa));
    REQUIRE(std::isfinite(value.temperature_c));
    if (implausibility(raw, value) != nullptr) continue;
    ++plausible;
    REQUIRE(value.pressure_pa >= 30e3);
    REQUIRE(value.pressure_pa <= 120e3);
  }
  CHECK(plausible > 100);
  const RawResult empty{kNoResult, 8'000'000};
  CHECK(implausibility(empty, {96'000.0, 20.0}) != nullptr);
}

TEST_CASE("more oversampling takes longer and is less noisy, and the default settings fit into a second") {
  for (int times = 2; times <= 32; times *= 2) {
    CHECK(pressure_noise_pa(times) < pressure_noise_pa(times / 2));
    CHECK(measurement_time_s(times, 1) > measurement_time_s(times / 2, 1));
  }
  CHECK(pressure_noise_pa(32) == 0.9);
  CHECK(busy_time_s(Settings{}) < 1.0);
}

}  // namespace isobar::test::test_bmp390_compensation
