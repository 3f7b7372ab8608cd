// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "drivers/ms5611/compensation.hpp"
#include "drivers/ms5611/settings.hpp"
#include "tests/drivers/ms5611/known_sensor.hpp"

namespace isobar::test::test_ms5611_compensation {

using namespace isobar::ms5611;

namespace {

struct IntegerResult {
  std::int64_t temperature_centi_c;
  std::int64_t pressure_pa;
};

/// The data sheet's integer formulas with 64 bit, second order included; divisions truncate towards zero.
IntegerResult by_integers(const Prom& c, std::int64_t d1, std::int64_t d2) {
  const std::int64_t dt = d2 - c[5] * std::int64_t{256};
  std::int64_t temp = 2'000 + dt * c[6] / 8'388'608;
  std::int64_t off = c[2] * std::int64_t{65'536} + c[4] * dt / 128;
  std::int64_t sens = c[1] * std::int64_t{32'768} + c[3] * dt / 256;
  if (temp < 2'000) {
    const std::int64_t t2 = dt * dt / 2'147'483'648;
    std::int64_t off2 = 5 * (temp - 2'000) * (temp - 2'000) / 2;
    std::int64_t sens2 = 5 * (temp - 2'000) * (temp - 2'000) / 4;
    if (temp < -1'500) {
      off2 += 7 * (temp + 1'500) * (temp + 1'500);
      sens2 += 11 * (temp + 1'500) * (temp + 1'500) / 2;
    }
    temp -= t2;
    off -= off2;
    sens -= sens2;
  }
  return {temp, (d1 * sens / 2'097'152 - off) / 32'768};
}

}  // namespace

TEST_CASE("the data sheet's example: 20.07 degrees C and 1000.09 mbar") {
  const Compensated value = compensate(isobar::ms5611::kKnownProm, isobar::ms5611::kExampleResult);
  // The data sheet truncates to 0.01 degrees and 0.01 mbar = 1 Pa.
  CHECK(std::floor(value.temperature_c * 100.0) == 2'007.0);
  CHECK(std::floor(value.pressure_pa) == isobar::ms5611::kKnownPressurePa);
  const IntegerResult integers = by_integers(isobar::ms5611::kKnownProm, 9'085'466, 8'569'150);
  CHECK(integers.temperature_centi_c == 2'007);
  CHECK(integers.pressure_pa == 100'009);
}

TEST_CASE(
    "from -40 to 85 degrees C the result is that of the data sheet's integers, without their truncation") {
  for (std::int64_t d2 = 6'600'000; d2 <= 10'500'000; d2 += 50'000) {
    for (std::int64_t d1 = 4'000'000; d1 <= 10'000'000; d1 += 500'000) {
      const IntegerResult integers = by_integers(isobar::ms5611::kKnownProm, d1, d2);
      const Compensated value = compensate(isobar::ms5611::kKnownProm,
                                           {static_cast<std::uint32_t>(d1), static_cast<std::uint32_t>(d2)});
      CHECK(std::abs(value.temperature_c * 100.0 - static_cast<double>(integers.temperature_centi_c)) < 2.0);
      // The integers truncate the temperature to 0.01 degrees, from which the second order makes up to 1 Pa,
      // and below -15 degrees up to 4 Pa.
      const double tolerance_pa = value.temperature_c < -15.0 ? 5.0 : 2.5;
      CHECK(std::abs(value.pressure_pa - static_cast<double>(integers.pressure_pa)) < tolerance_pa);
    }
  }
}

TEST_CASE("the CRC of the application note's example is 0xB, and that of any memory is a division's rest") {
  CHECK(crc4(isobar::ms5611::kNoteProm) == 0x0B);
  CHECK(implausibility(isobar::ms5611::kNoteProm) == nullptr);
  std::mt19937 random(3);
  for (int i = 0; i < 1'000; ++i) {
    Prom prom{};
    for (auto& word : prom) word = static_cast<std::uint16_t>(random());
    CHECK(crc4(prom) == divided_crc4(prom));
  }
}

TEST_CASE("every flipped bit of a memory, and memories of other devices, are found") {
  const Prom sound = sealed(isobar::ms5611::kKnownProm);
  CHECK(implausibility(sound) == nullptr);
  for (std::size_t bit = 0; bit < 16 * kPromWords - 8; ++bit) {
    Prom flipped = sound;
    flipped[bit / 16] ^= static_cast<std::uint16_t>(1U << bit % 16);
    if (bit / 16 < kPromWords - 1) CHECK(implausibility(flipped) != nullptr);
  }
  Prom level{};
  CHECK(implausibility(level) != nullptr);  // its CRC is right: a bus held low
  level.fill(0xFFFF);
  CHECK(implausibility(level) != nullptr);
}

TEST_CASE("every input gives finite numbers, and implausible results name the rule") {
  std::mt19937 random(7);
  std::size_t plausible = 0;
  for (int i = 0; i < 50'000; ++i) {
    Prom prom = isobar::ms5611::kKnownProm;
    for (int flips = i % 3; flips > 0; --flips) prom[random() % 8] = static_cast<std::uint16_t>(random());
    const RawResult raw{static_cast<std::uint32_t>(random() & 0xFFFFFFU),
                        static_cast<std::uint32_t>(random() & 0xFFFFFFU)};
    const Compensated value = compensate(prom, raw);
    REQUIRE(std::isfinite(value.pressure_pa));
    REQUIRE(std::isfinite(value.temperature_c));
    if (implausibility(raw, value) != nullptr) continue;
    ++plausible;
    REQUIRE(value.pressure_pa >= 30e3);
    REQUIRE(value.pressure_pa <= 120e3);
  }
  CHECK(plausible > 100);
  CHECK(implausibility(RawResult{0, 8'000'000}, {96'000.0, 20.0}) != nullptr);
  CHECK(implausibility(RawResult{8'000'000, 0}, {96'000.0, 20.0}) != nullptr);
}

TEST_CASE("more oversampling takes longer and is less noisy, and the default settings fit into a second") {
  for (int times = 512; times <= 4096; times *= 2) {
    CHECK(pressure_noise_pa(times) < pressure_noise_pa(times / 2));
    CHECK(longest_conversion_s(times) > longest_conversion_s(times / 2));
    CHECK(longest_conversion_s(times) > conversion_s(times));
  }
  CHECK(busy_time_s(Settings{}) < 1.0);
}

}  // namespace isobar::test::test_ms5611_compensation
