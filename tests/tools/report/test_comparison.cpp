// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/statistics/paired.hpp"
#include "tools/comparison.hpp"

namespace isobar::test::test_comparison {

using namespace isobar::tools;
using doctest::Approx;

namespace {

ComparedRecording recording(double ate_a_m, double ate_b_m) {
  ComparedRecording one;
  one.name = "r";
  one.first.ate_rms_m = ate_a_m;
  one.second.ate_rms_m = ate_b_m;
  return one;
}

const ComparedFigure& figure_with(const std::vector<ComparedFigure>& figures, const std::string& word) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const ComparedFigure& one) {
    return one.label.find(word) != std::string::npos;
  });
  REQUIRE(found != figures.end());
  return *found;
}

}  // namespace

TEST_CASE("the paired difference is Student's: mean, and t times the standard error") {
  // Differences 1, 2, 3: mean 2, deviation 1, standard error 1 / sqrt(3), t(2) = 4.303.
  const PairedDifference difference = paired_difference({0.0, 0.0, 10.0}, {1.0, 2.0, 13.0});
  CHECK(difference.count == 3);
  CHECK(difference.mean == Approx(2.0));
  CHECK(difference.margin == Approx(4.303 / std::sqrt(3.0)));
  CHECK_FALSE(difference.is_clear());
  CHECK(paired_difference({0.0, 0.0, 0.0}, {1.0, 1.1, 0.9}).is_clear());
}

TEST_CASE("one pair says nothing of scatter; pairs without a value are left out") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const PairedDifference one = paired_difference({1.0, none, 2.0}, {5.0, 1.0, none});
  CHECK(one.count == 1);
  CHECK(one.mean == Approx(4.0));
  CHECK(std::isnan(one.margin));
  CHECK_FALSE(one.is_clear());
  CHECK(paired_difference({}, {}).count == 0);
}

TEST_CASE("the second side is better by more than the scatter, worse, within it, or on one recording only") {
  const auto verdict = [](const std::vector<ComparedRecording>& recordings) {
    return figure_with(compare_figures(recordings), "rms").verdict;
  };
  CHECK(verdict({recording(0.10, 0.05), recording(0.20, 0.15), recording(0.30, 0.249)}) ==
        ComparisonVerdict::kBetter);
  CHECK(verdict({recording(0.05, 0.10), recording(0.15, 0.20), recording(0.249, 0.30)}) ==
        ComparisonVerdict::kWorse);
  CHECK(verdict({recording(0.10, 0.05), recording(0.10, 0.15), recording(0.10, 0.10)}) ==
        ComparisonVerdict::kWithinScatter);
  CHECK(verdict({recording(0.10, 0.05)}) == ComparisonVerdict::kUnknown);
  CHECK(verdict({recording(0.10, 0.10), recording(0.20, 0.20)}) == ComparisonVerdict::kWithinScatter);
}

TEST_CASE("an error counts by its magnitude, and figures that a side lacks are left out") {
  ComparedRecording one = recording(0.1, 0.1);
  one.first.final_height_error_m = -0.30;
  one.second.final_height_error_m = 0.10;
  one.first.yaw_drift_rad = 0.1;
  const std::vector<ComparedFigure> figures = compare_figures({one});
  bool found = false;
  for (const ComparedFigure& figure : figures) {
    found |= figure.first_median == Approx(0.30) && figure.second_median == Approx(0.10);
    CHECK(std::isfinite(figure.difference.mean));
  }
  CHECK(found);
}

TEST_CASE("the table of one recording says which side is better there, the summary that it is no proof") {
  const auto of_one = compare_figures({recording(0.10, 0.05)});
  CHECK(comparison_table(of_one).find("better here") != std::string::npos);
  CHECK(comparison_summary(of_one).find("One recording says nothing of scatter") != std::string::npos);
  CHECK(comparison_table(compare_figures({recording(0.05, 0.10)})).find("worse here") != std::string::npos);
  const auto equal = compare_figures({recording(0.10, 0.10), recording(0.20, 0.20)});
  CHECK(comparison_table(equal).find("the same") != std::string::npos);
  const std::string summary = comparison_summary(equal);
  CHECK(summary.starts_with("B is better in 0 of " + std::to_string(equal.size()) +
                            " figures, worse in 0, the same in " + std::to_string(equal.size())));
}

}  // namespace isobar::test::test_comparison
