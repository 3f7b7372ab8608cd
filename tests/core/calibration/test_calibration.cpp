// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

#include "core/calibration/calibration.hpp"
#include "core/errors.hpp"
#include "tests/core/calibration/chamber.hpp"

namespace isobar::test::test_calibration {

namespace {

constexpr Compensation::Variables kVariables{98'000.0, 1'500.0, 25.0, 25.0};

/// Coefficients in u and v [Pa]: an offset and a scale error as of a cheap sensor, -1.9 Pa/K.
Eigen::Matrix4d simple_truth() {
  Eigen::Matrix4d c = Eigen::Matrix4d::Zero();
  c(0, 0) = 98'000.0 + 63.0;
  c(1, 0) = 1'500.0 - 4.0;
  c(2, 0) = 1.5;
  c(3, 0) = -2.0;
  c(0, 1) = -47.0;
  return c;
}

Chamber chamber(const Eigen::Matrix4d& truth, unsigned seed) {
  return {Compensation(truth, kVariables), 4.0, seed};
}

const ModelResult& recommended(const Calibration& calibration) {
  return calibration.models[calibration.recommended];
}

}  // namespace

TEST_CASE(
    "a chamber run with 4 Pa of noise recovers the true pressure to 1 Pa with no more terms than the sensor "
    "has") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const Chamber simulated = chamber(simple_truth(), seed);
    const Calibration calibration = calibrate(simulated.record());
    const ModelResult& best = recommended(calibration);
    CHECK(best.model == CompensationModel::kSimple);
    CHECK(simulated.systematic_rms_pa(best.compensation, calibration.range) <= 1.0);
    // The residual is the noise: 4 Pa, to three standard errors of 8280 samples.
    CHECK(best.residual.sd_pa == doctest::Approx(4.0).epsilon(0.025));
    CHECK(calibration.config(best.model).sigma_pa == doctest::Approx(4.0).epsilon(0.05));
  }
}

TEST_CASE("each kind of term is recovered by the model that contains it") {
  struct Kind {
    CompensationModel expected;
    int i;
    int j;
    double pa;
  };
  for (const Kind& kind : {Kind{CompensationModel::kInd, 0, 2, 15.0}, Kind{CompensationModel::kM, 1, 1, 12.0},
                           Kind{CompensationModel::kFull, 2, 2, 60.0}}) {
    CAPTURE(kCompensationModelNames.name(kind.expected));
    Eigen::Matrix4d truth = simple_truth();
    truth(kind.i, kind.j) += kind.pa;
    if (kind.expected == CompensationModel::kFull) truth(1, 2) -= 50.0;
    const Chamber simulated = chamber(truth, 11);
    const Calibration calibration = calibrate(simulated.record());
    CHECK(recommended(calibration).model == kind.expected);
    CHECK(simulated.systematic_rms_pa(recommended(calibration).compensation, calibration.range) <= 1.0);
  }
}

TEST_CASE("a sensor with a constant error gets the offset model") {
  Eigen::Matrix4d truth = Eigen::Matrix4d::Zero();
  truth(0, 0) = 98'000.0 - 120.0;
  truth(1, 0) = 1'500.0;
  const Calibration calibration = calibrate(chamber(truth, 5).record());
  CHECK(recommended(calibration).model == CompensationModel::kOffset);
  CHECK(calibration.reason.find("offset") != std::string::npos);
  // Uncompensated, the error is the offset; compensated, the noise.
  CHECK(calibration.model(CompensationModel::kNone).residual.rms_pa == doctest::Approx(120.0).epsilon(0.01));
  CHECK(calibration.model(CompensationModel::kOffset).residual.rms_pa == doctest::Approx(4.0).epsilon(0.025));
}

TEST_CASE("the blockwise factor gives the solution of a decomposition of the whole matrix") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<CalibrationPair> pairs;
  for (int k = 0; k < 5000; ++k) {
    const double p = 98'000.0 + 700.0 * normal(random);
    const double t = 25.0 + 8.0 * normal(random);
    pairs.push_back({p + 30.0 * normal(random) - 2.0 * t, p, t});
  }
  DesignFactor halves(kVariables);
  DesignFactor second(kVariables);
  halves.add(std::span(pairs).first(1'777));
  second.add(std::span(pairs).subspan(1'777));
  halves.add(second);
  Eigen::MatrixXd design(5000, 7);
  Eigen::VectorXd right(5000);
  for (int k = 0; k < 5000; ++k) {
    const auto& pair = pairs[static_cast<std::size_t>(k)];
    const double u = (pair.pressure_pa - 98'000.0) / 1'500.0;
    const double v = (pair.temperature_c - 25.0) / 25.0;
    design.row(k) << 1.0, v, u, u * v, u * u, u * u * v, u * u * u;
    right(k) = pair.reference_pa - pair.pressure_pa;
  }
  const Eigen::VectorXd expected = design.colPivHouseholderQr().solve(right);
  const auto found = halves.solve(kMaskM);
  const Eigen::Matrix4d& c = found.compensation.centred();
  // 1e-7 Pa: rounding of a stable solution, a millionth of a barometer's resolution.
  CHECK(std::abs(c(0, 0) - 98'000.0 - expected(0)) < 1e-7);
  CHECK(std::abs(c(0, 1) - expected(1)) < 1e-7);
  CHECK(std::abs(c(1, 0) - 1'500.0 - expected(2)) < 1e-7);
  CHECK(std::abs(c(1, 1) - expected(3)) < 1e-7);
  CHECK(std::abs(c(2, 0) - expected(4)) < 1e-7);
  CHECK(std::abs(c(2, 1) - expected(5)) < 1e-7);
  CHECK(std::abs(c(3, 0) - expected(6)) < 1e-7);
  CHECK(c(0, 2) == 0.0);
  CHECK(found.rank == 7);
}

TEST_CASE("centred and scaled, all sixteen columns are well conditioned") {
  const Calibration calibration = calibrate(chamber(simple_truth(), 2).record());
  // In plain powers of pascals and degrees it is beyond 1e15.
  CHECK(calibration.model(CompensationModel::kFull).condition_number < 1e4);
  CHECK(calibration.model(CompensationModel::kP).condition_number < 1e2);
}

TEST_CASE("temperature terms are not fitted at a constant temperature, and the reason is given") {
  auto recordings = chamber(simple_truth(), 4).record();
  recordings.erase(recordings.begin(), recordings.end() - 1);  // the static hours: 22.0 +- 0.3 degC
  const Calibration calibration = calibrate(recordings);
  for (const ModelResult& result : calibration.models) {
    CAPTURE(kCompensationModelNames.name(result.model));
    CHECK(result.left_out.empty() == !uses_temperature(result.model));
  }
  CHECK(calibration.model(CompensationModel::kSimple).left_out.find("0.6 K") != std::string::npos);
  CHECK_FALSE(uses_temperature(recommended(calibration).model));
  CHECK(calibration.warnings.size() == 2);  // narrow in temperature and, over five hours, in pressure
  CHECK(calibration.validation.find("one recording only") != std::string::npos);
}

TEST_CASE("exactly one temperature excludes temperature terms and no others") {
  auto recordings = chamber(simple_truth(), 4).record();
  for (auto& recording : recordings) {
    for (auto& pair : recording.pairs) pair.temperature_c = 21.0;
  }
  const Calibration calibration = calibrate(recordings);
  CHECK_FALSE(calibration.model(CompensationModel::kFull).left_out.empty());
  CHECK(std::isfinite(calibration.model(CompensationModel::kP).residual.rms_pa));
}

TEST_CASE("a reference that is the sensor itself, and too few pairs, are refused") {
  auto recordings = chamber(simple_truth(), 4).record();
  for (auto& recording : recordings) {
    for (auto& pair : recording.pairs) pair.reference_pa = pair.pressure_pa;
  }
  CHECK_THROWS_WITH_AS(calibrate(recordings), doctest::Contains("is the sensor itself"), DataError);
  CHECK_THROWS_WITH_AS(calibrate({}), doctest::Contains("only 0 samples"), DataError);
  recordings.resize(1);
  recordings[0].pairs.resize(10);
  CHECK_THROWS_WITH_AS(calibrate(recordings), doctest::Contains("only 10 samples"), DataError);
}

TEST_CASE(
    "the simplest of equivalent models is chosen, and a gain beyond its standard error justifies a "
    "coefficient") {
  const auto model = [](CompensationModel which, std::vector<double> squares) {
    ModelResult result;
    result.model = which;
    result.fold_mean_squares_pa2 = std::move(squares);
    return result;
  };
  const std::vector<double> weights(4, 0.25);
  // Means 22, 17 and 16.5; the standard error of the last is 0.65.
  const std::vector<ModelResult> one_is_enough{model(CompensationModel::kP, {20, 22, 23, 23}),
                                               model(CompensationModel::kSimple, {16, 17, 17, 18}),
                                               model(CompensationModel::kFull, {15, 16.5, 16.5, 18})};
  CHECK(simplest_within_one_error(one_is_enough, weights, 0.01) == 1);
  // The same means, but the scatter between recordings is too large to decide.
  const std::vector<ModelResult> unsure{model(CompensationModel::kP, {10, 12, 33, 33}),
                                        model(CompensationModel::kSimple, {7, 8, 26, 27}),
                                        model(CompensationModel::kFull, {6, 7, 26, 27})};
  CHECK(simplest_within_one_error(unsure, weights, 0.01) == 0);
  // Significantly better, but by less than least_gain.
  const std::vector<ModelResult> not_worth_it{model(CompensationModel::kP, {10.1, 10.1, 10.1, 10.1}),
                                              model(CompensationModel::kSimple, {10, 10, 10, 10})};
  CHECK(simplest_within_one_error(not_worth_it, weights, 0.01) == 0);
  CHECK(simplest_within_one_error(not_worth_it, weights, 0.001) == 1);
  const std::vector<ModelResult> left_out{model(CompensationModel::kP, {}),
                                          model(CompensationModel::kSimple, {1, 1, 1, 1})};
  CHECK(simplest_within_one_error(left_out, weights, 0.01) == 1);
  CHECK(simplest_within_one_error(left_out, {}, 0.01) == 0);
}

TEST_CASE("residual figures equal their definitions") {
  const std::vector<double> residuals{-3.0, 1.0, 1.0, 5.0, 1.0};
  const ResidualFigures figures = residual_figures(residuals);
  CHECK(figures.mean_pa == doctest::Approx(1.0));
  CHECK(figures.sd_pa == doctest::Approx(std::sqrt(32.0 / 5.0)));
  CHECK(figures.rms_pa == doctest::Approx(std::sqrt(37.0 / 5.0)));
  CHECK(figures.median_abs_pa == doctest::Approx(1.0));
  CHECK(figures.p95_abs_pa == doctest::Approx(4.6));  // four fifths between 3 and 5
}

}  // namespace isobar::test::test_calibration
