// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/calibration/calibration_pairs.hpp"
#include "core/calibration/clock_shift.hpp"

namespace isobar::test::test_clock_shift {

namespace {

std::int64_t stamp(double time_s) { return static_cast<std::int64_t>(std::llround(time_s * 1e9)); }

/// Weather: a random walk with one value a second, linear between; the same for all sensors.
class Weather {
 public:
  explicit Weather(unsigned seed, double walk_pa_sqrt_s = 0.15) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, walk_pa_sqrt_s);
    for (double p = 98'500.0; values_.size() < 250'000; p += normal(random)) values_.push_back(p);
  }
  double operator()(double time_s) const {
    const auto k = static_cast<std::size_t>(time_s);
    return values_[k] + (time_s - std::floor(time_s)) * (values_[k + 1] - values_[k]);
  }

 private:
  std::vector<double> values_;
};

PressureSeries sampled(const std::function<double(double)>& pressure_pa, double from_s, double to_s,
                       double every_s, double clock_s, double noise_pa, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_pa);
  std::vector<std::int64_t> stamps;
  std::vector<double> values;
  for (double t = from_s; t < to_s; t += every_s) {
    stamps.push_back(stamp(t + clock_s));
    values.push_back(pressure_pa(t) + normal(random));
  }
  return {stamps, std::move(values)};
}

}  // namespace

TEST_CASE("a mean over a window is the integral of the linear interpolation") {
  const PressureSeries series({stamp(0), stamp(1), stamp(3)}, {10.0, 20.0, 0.0}, 5.0);
  CHECK(series.mean_pa(0.5, 0.0) == doctest::Approx(15.0));
  CHECK(series.mean_pa(2.0, 0.0) == doctest::Approx(10.0));
  CHECK(series.mean_pa(1.5, 3.0) == doctest::Approx((15.0 + 20.0) / 3.0));
  CHECK(series.mean_pa(1.0, 1.0) == doctest::Approx((0.5 * 17.5 + 0.5 * 17.5)));
  CHECK(std::isnan(series.mean_pa(3.1, 0.0)));
  CHECK(std::isnan(series.mean_pa(0.4, 1.0)));
  CHECK(std::isnan(PressureSeries({stamp(0)}, {1.0}).mean_pa(0.0, 0.0)));
}

TEST_CASE("a mean is undefined in a gap") {
  const PressureSeries series({stamp(0), stamp(1), stamp(2), stamp(100), stamp(101)}, {1, 2, 3, 4, 5});
  CHECK(series.mean_pa(1.5, 0.0) == doctest::Approx(2.5));
  CHECK(std::isnan(series.mean_pa(50.0, 0.0)));
  CHECK(std::isnan(series.mean_pa(2.0, 1.0)));
  CHECK(series.mean_pa(100.5, 1.0) == doctest::Approx(4.5));
}

TEST_CASE("a wrong time zone is found to a few seconds from weather alone, at any sample rates") {
  struct Rates {
    double sensor_s;
    double reference_s;
  };
  for (const Rates& rates : {Rates{60.0, 60.0}, Rates{10.0, 60.0}, Rates{60.0, 5.0}}) {
    CAPTURE(rates.sensor_s);
    CAPTURE(rates.reference_s);
    const Weather weather(7);
    // The sensor drifts with the daily temperature by more than the weather changes in an hour.
    const auto with_drift = [&](double t) { return weather(t) + 40.0 * std::sin(t / 9'000.0) + 300.0; };
    const std::vector<PressureSeries> sensor{
        sampled(with_drift, 20'000.0, 70'000.0, rates.sensor_s, 7'213.0, 1.0, 1),
        sampled(with_drift, 80'000.0, 120'000.0, rates.sensor_s, 7'213.0, 1.0, 2)};
    const PressureSeries reference = sampled(weather, 10'000.0, 140'000.0, rates.reference_s, 0.0, 1.0, 3);
    const ClockShift shift = find_clock_shift(sensor, reference);
    CHECK(shift.doubt.empty());
    CHECK(shift.correlation > 0.5);
    // An eighth of the slower log's interval, and the reported standard deviation.
    CHECK(std::abs(shift.shift_s + 7'213.0) < 7.5);
    CHECK(std::abs(shift.shift_s + 7'213.0) < 4.0 * shift.sigma_s);
    CHECK(shift.next_best_correlation < 0.5 * shift.correlation);
  }
}

TEST_CASE("logs of different weather, of constant pressure, or too short give a doubtful shift") {
  const Weather here(7);
  const Weather elsewhere(8);
  const auto noon = [](double) { return 98'000.0; };
  const PressureSeries reference = sampled(here, 10'000.0, 100'000.0, 60.0, 0.0, 1.0, 3);
  const auto doubt = [&](const PressureSeries& sensor) {
    return find_clock_shift({&sensor, 1}, reference).doubt;
  };
  CHECK_FALSE(doubt(sampled(elsewhere, 20'000.0, 90'000.0, 60.0, 0.0, 1.0, 1)).empty());
  CHECK_FALSE(doubt(sampled(noon, 20'000.0, 90'000.0, 60.0, 0.0, 1.0, 1)).empty());
  CHECK_FALSE(doubt(sampled(here, 20'000.0, 20'600.0, 60.0, 0.0, 1.0, 1)).empty());
  CHECK_FALSE(doubt(PressureSeries({}, {})).empty());
}

TEST_CASE("a periodic pressure has no unique shift") {
  const auto waves = [](double t) { return 98'000.0 + 50.0 * std::sin(t * 6.283185307 / 1'800.0); };
  const PressureSeries reference = sampled(waves, 0.0, 90'000.0, 60.0, 0.0, 0.3, 3);
  const PressureSeries sensor = sampled(waves, 20'000.0, 70'000.0, 60.0, 0.0, 0.3, 4);
  CHECK(find_clock_shift({&sensor, 1}, reference).doubt == "the logs correlate almost equally at two shifts");
}

TEST_CASE("samples are paired with the reference at the shifted time, and unpaired ones are counted") {
  std::vector<std::int64_t> stamps;
  std::vector<double> values;
  for (int k = 0; k <= 100; ++k) {
    stamps.push_back(stamp(k));
    values.push_back(1'000.0 + 2.0 * k);
  }
  const PressureSeries reference(stamps, std::move(values));
  std::vector<PressureSample> sensor;
  for (int k = 0; k < 10; ++k) sensor.push_back({stamp(500.0 + 10.0 * k), 900.0, k == 3 ? NAN : 20.0});
  PairingCounts counts;
  const auto pairs = pair_with_reference(sensor, reference, -455.0, counts);  // 45, 55, … 135 s
  // Paired: 45, 55, 65, 85 and 95 s, the last one exactly 5 s before the end; 75 s has no temperature.
  REQUIRE(pairs.size() == 5);
  CHECK(pairs[0].reference_pa == doctest::Approx(1'090.0));
  CHECK(pairs[4].reference_pa == doctest::Approx(1'190.0));
  CHECK(counts.paired == 5);
  CHECK(counts.without_temperature == 1);
  CHECK(counts.without_reference == 4);
}

TEST_CASE("spikes of either sensor are removed, slow errors are not") {
  std::vector<CalibrationRecording> recordings(2);
  for (int k = 0; k < 200; ++k) {
    const double temperature_pa = 100.0 * std::sin(0.1 * k);
    recordings[k % 2].pairs.push_back({98'000.0 + temperature_pa, 98'000.0, 20.0});
  }
  CHECK(drop_spikes(recordings) == 0);
  recordings[0].pairs[7].pressure_pa += 30'000.0;
  recordings[1].pairs[9].reference_pa -= 5'000.0;
  CHECK(drop_spikes(recordings) == 2);
  CHECK(recordings[0].pairs.size() == 99);
}

}  // namespace isobar::test::test_clock_shift
