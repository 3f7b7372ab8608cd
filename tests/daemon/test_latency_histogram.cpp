// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/latency_histogram.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace isobar::test::test_latency_histogram {

TEST_CASE("quantiles of 1 to 100 ms are right to half a bucket, and only of what is new") {
  LatencyHistogram histogram;
  CHECK(std::isnan(histogram.quantile_ms(0.5, {})));
  for (int ms = 1; ms <= 100; ++ms) histogram.note(ms * 1'000'000);
  CHECK(histogram.quantile_ms(0.5, {}) == doctest::Approx(50.0).epsilon(0.1));
  CHECK(histogram.quantile_ms(0.99, {}) == doctest::Approx(99.0).epsilon(0.1));
  const LatencyHistogram before = histogram;
  histogram.note(3'000'000);
  CHECK(histogram.quantile_ms(0.99, before) == doctest::Approx(3.0).epsilon(0.1));
}

TEST_CASE("durations beyond the buckets count in the first and the last") {
  LatencyHistogram histogram;
  histogram.note(-5);
  CHECK(histogram.quantile_ms(0.5, {}) < 0.011);
  const LatencyHistogram before = histogram;
  histogram.note(3'600'000'000'000);
  CHECK(histogram.quantile_ms(0.5, before) > 400.0);
}

}  // namespace isobar::test::test_latency_histogram
