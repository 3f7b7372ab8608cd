// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "drivers/dps310/compensation.hpp"
#include "drivers/dps310/settings.hpp"
#include "tests/drivers/dps310/known_sensor.hpp"

namespace isobar::test::test_compensation {

using namespace isobar::dps310;

namespace {

/// Sets `bits` bits from bit `first` on, one by one: independent of the decoder.
void set_field(CoefficientBytes& bytes, int first, int bits, std::int32_t value) {
  for (int i = 0; i < bits; ++i) {
    const bool one = (static_cast<std::uint32_t>(value) & 1U << (bits - 1 - i)) != 0;
    const auto mask = static_cast<std::uint8_t>(0x80U >> static_cast<unsigned>((first + i) % 8));
    auto& byte = bytes[static_cast<std::size_t>((first + i) / 8)];
    byte = static_cast<std::uint8_t>(one ? byte | mask : byte & ~mask);
  }
}

}  // namespace

TEST_CASE("the coefficients of a known sensor are read from their 18 bytes") {
  CHECK(decode_coefficients(dps310::kKnownBytes) == dps310::kKnownCoefficients);
}

TEST_CASE(
    "every coefficient has its own bits: both ends of its range decode and leave the others unchanged") {
  struct Field {
    std::int32_t Coefficients::*member;
    int first;
    int bits;
  };
  constexpr std::array<Field, 9> kFields{{{&Coefficients::c0, 0, 12},
                                          {&Coefficients::c1, 12, 12},
                                          {&Coefficients::c00, 24, 20},
                                          {&Coefficients::c10, 44, 20},
                                          {&Coefficients::c01, 64, 16},
                                          {&Coefficients::c11, 80, 16},
                                          {&Coefficients::c20, 96, 16},
                                          {&Coefficients::c21, 112, 16},
                                          {&Coefficients::c30, 128, 16}}};
  for (const Field& field : kFields) {
    const std::int32_t highest = (1 << (field.bits - 1)) - 1;
    for (const std::int32_t value : {highest, -highest - 1, -1, 0, 1}) {
      CoefficientBytes bytes = dps310::kKnownBytes;
      set_field(bytes, field.first, field.bits, value);
      Coefficients expected = dps310::kKnownCoefficients;
      expected.*field.member = value;
      CHECK(decode_coefficients(bytes) == expected);
    }
  }
}

TEST_CASE("coefficients of an unloaded memory and of a dead bus are refused") {
  CoefficientBytes bytes{};
  CHECK(implausibility(bytes) != nullptr);
  bytes.fill(0xFF);
  CHECK(implausibility(bytes) != nullptr);
  CHECK(implausibility(dps310::kKnownBytes) == nullptr);
  Coefficients c = decode_coefficients(dps310::kKnownBytes);
  CHECK(c.c10 != 0);
  bytes = dps310::kKnownBytes;
  set_field(bytes, 44, 20, 0);  // pressure without influence on the result
  CHECK(implausibility(bytes) != nullptr);
}

TEST_CASE("results are 24 bit two's complement") {
  CHECK(decode_result({0xFA, 0x36, 0xE9, 0x05, 0x05, 0x11}) == RawResult{-379'159, 328'977});
  CHECK(decode_result({0x7F, 0xFF, 0xFF, 0x80, 0x00, 0x00}) == RawResult{8'388'607, -8'388'608});
  CHECK(decode_result({0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x00}) == RawResult{-1, 0});
}

TEST_CASE("every input gives finite numbers, and implausible results name the rule") {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> any(0, 255);
  std::uniform_int_distribution<int> power(0, 7);
  std::size_t implausible = 0;
  for (int i = 0; i < 50'000; ++i) {
    CoefficientBytes coefficients;
    std::array<std::uint8_t, kResultBytes> result{};
    for (auto& byte : coefficients) byte = static_cast<std::uint8_t>(any(random));
    for (auto& byte : result) byte = static_cast<std::uint8_t>(any(random));
    const RawResult raw = decode_result(result);
    const Compensated value = compensate(decode_coefficients(coefficients), raw,
                                         scale_factor(1 << power(random)), scale_factor(1 << power(random)));
    REQUIRE(std::isfinite(value.pressure_pa));
    REQUIRE(std::isfinite(value.temperature_c));
    if (implausibility(raw, value) != nullptr) {
      ++implausible;
    } else {
      REQUIRE(value.pressure_pa >= 30e3);
      REQUIRE(value.pressure_pa <= 120e3);
      REQUIRE(value.temperature_c >= -40.0);
      REQUIRE(value.temperature_c <= 85.0);
    }
  }
  // Random coefficients span +-400 K and more of temperature and +-500 kPa: most results are not air
  // pressure.
  CHECK(implausible > 40'000);
  CHECK(implausible < 50'000);
}

TEST_CASE("an empty result register is refused, also if the compensated pressure is plausible") {
  const Compensated fine{95'000.0, 20.0};
  CHECK(implausibility(RawResult{kNoResult, 0}, fine) != nullptr);
  CHECK(implausibility(RawResult{0, kNoResult}, fine) != nullptr);
  CHECK(implausibility(RawResult{0, 0}, fine) == nullptr);
}

TEST_CASE("more oversampling is never noisier or faster, and the default settings fit into a second") {
  for (int oversampling = 2; oversampling <= 128; oversampling *= 2) {
    CHECK(pressure_noise_pa(oversampling) <= pressure_noise_pa(oversampling / 2));
    CHECK(measurement_time_s(oversampling) > measurement_time_s(oversampling / 2));
  }
  CHECK(busy_time_s(Settings{}) < 1.0);
  Settings greedy;
  greedy.pressure_oversampling = 32;  // 32 of 53.2 ms alone are 1.7 s
  CHECK(busy_time_s(greedy) > 1.0);
}

}  // namespace isobar::test::test_compensation
