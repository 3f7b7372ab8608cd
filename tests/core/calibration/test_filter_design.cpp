// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/altitude/pressure_filter.hpp"
#include "core/calibration/filter_design.hpp"

namespace isobar::test::test_filter_design {

namespace {

constexpr double kSigma = 0.35;
constexpr double kDt = 1.0 / 32.0;

/// Filter in its steady state.
PressureFilter settled_filter(const FilterDesign& design) {
  PressureFilter filter(design.walk_pa_sqrt_s);
  for (int i = 0; i < 20'000; ++i) filter.add(1e5, kDt, kSigma * kSigma);
  return filter;
}

}  // namespace

TEST_CASE("a filter built from a design has its gain, lag and noise") {
  for (const double lag_s : {0.1, 0.5, 2.0, 8.0}) {
    const FilterDesign design = design_for_lag(kSigma, kDt, lag_s);
    CHECK(design.delay_s == doctest::Approx(lag_s));
    PressureFilter filter = settled_filter(design);
    CHECK(filter.delay_s() == doctest::Approx(lag_s).epsilon(1e-6).scale(0.0));
    filter.add(1e5 + 1.0, kDt, kSigma * kSigma);
    CHECK(filter.pressure_pa() - 1e5 == doctest::Approx(design.gain).epsilon(1e-6).scale(0.0));
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0.0, kSigma);
    double squares = 0.0;
    constexpr int kCount = 200'000;
    for (int i = 0; i < 2000; ++i) filter.add(1e5 + normal(random), kDt, kSigma * kSigma);
    for (int i = 0; i < kCount; ++i) {
      filter.add(1e5 + normal(random), kDt, kSigma * kSigma);
      squares += std::pow(filter.pressure_pa() - 1e5, 2);
    }
    // 200 000 samples are 400 independent outputs at 8 s: 3.5 % of sigma, tolerance: two times that.
    CHECK(std::sqrt(squares / kCount) == doctest::Approx(design.output_sigma_pa).epsilon(0.08).scale(0.0));
  }
}

TEST_CASE("a sine at the design's bandwidth is attenuated to 1/sqrt(2)") {
  for (const double bandwidth_hz : {0.05, 0.5, 4.0}) {
    const FilterDesign design = design_for_bandwidth(kSigma, kDt, bandwidth_hz);
    CHECK(design.bandwidth_hz == doctest::Approx(bandwidth_hz));
    PressureFilter filter = settled_filter(design);
    double sine = 0.0;
    double cosine = 0.0;
    const int period = static_cast<int>(std::lround(32.0 / bandwidth_hz));
    for (int i = 0; i < 40 * period; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / period;
      filter.add(1e5 + std::sin(phase), kDt, kSigma * kSigma);
      if (i < 20 * period) continue;
      sine += (filter.pressure_pa() - 1e5) * std::sin(phase);
      cosine += (filter.pressure_pa() - 1e5) * std::cos(phase);
    }
    CHECK(std::hypot(sine, cosine) / (10.0 * period) ==
          doctest::Approx(1.0 / std::numbers::sqrt2).epsilon(1e-4).scale(0.0));
  }
}

TEST_CASE("a design for an output noise has that noise") {
  const FilterDesign design = design_for_noise(kSigma, kDt, 0.1);  // the paper's target resolution
  CHECK(design.output_sigma_pa == doctest::Approx(0.1));
  CHECK(design_for_lag(kSigma, kDt, design.delay_s).output_sigma_pa == doctest::Approx(0.1));
  // A filter without a -3 dB point below the Nyquist frequency reports the Nyquist frequency.
  CHECK(design_for_gain(kSigma, kDt, 0.95).bandwidth_hz == doctest::Approx(16.0));
}

TEST_CASE(
    "with stamps corrected for its delay, the filter follows a climb without lag from the first sample on") {
  // Uneven stamps and changing noise: the delay is the actual one, not that of the steady state.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> interval(0.005, 0.2);
  const auto climb_pa = [](double time_s) { return 1e5 - 6.0 * time_s; };  // 0.5 m/s
  PressureFilter filter(0.1);
  double time_s = 0.0;
  filter.add(climb_pa(time_s), 0.0, 0.1);
  for (int i = 0; i < 500; ++i) {
    const double dt_s = interval(random);
    time_s += dt_s;
    filter.add(climb_pa(time_s), dt_s, i < 250 ? 0.1 : 2.0);
    // Rounding of 1e5 Pa.
    CHECK(filter.pressure_pa() ==
          doctest::Approx(climb_pa(time_s - filter.delay_s())).epsilon(1e-12).scale(0.0));
  }
  CHECK(filter.delay_s() > 1.0);
}

}  // namespace isobar::test::test_filter_design
