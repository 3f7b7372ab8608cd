// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/weather_smoother.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "core/calibration/still_period.hpp"
#include "core/squared.hpp"
#include "core/stamp.hpp"

namespace isobar {
namespace {

// Smallest number of rows from which the noise is estimated.
constexpr std::size_t kRowsForNoise = 30;
// Extrapolation beyond the first and the last row.
constexpr double kExtrapolationS = 300.0;
// Initial uncertainty of the level: uninformative.
constexpr double kLevelSigmaPa = 1e4;

/// Level above the first row [Pa] and rate [Pa/s].
struct State {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};

struct Step {
  Eigen::Matrix2d transition;
  State predicted;
  State filtered;
};

/// Rate: first-order Gauss-Markov process. Level: integral of the rate plus a random walk.
State predict(const State& state, double dt_s, const WeatherModel& model, Eigen::Matrix2d& F) {
  const double keep = std::exp(-dt_s / model.rate_time_s);
  F << 1.0, model.rate_time_s * (1.0 - keep), 0.0, keep;
  const double rate_variance = squared(model.rate_sigma_pa_s) * (1.0 - keep * keep);
  Eigen::Matrix2d Q;
  // First order: a change of rate during the step acts on the level for half of it on average.
  Q << squared(model.walk_pa_sqrt_s) * dt_s + rate_variance * dt_s * dt_s / 3.0, rate_variance * dt_s / 2.0,
      rate_variance * dt_s / 2.0, rate_variance;
  return {F * state.mean, F * state.covariance * F.transpose() + Q};
}

State update(const State& state, double pressure_pa, double variance_pa2) {
  const Eigen::Vector2d gain = state.covariance.col(0) / (state.covariance(0, 0) + variance_pa2);
  return {state.mean + gain * (pressure_pa - state.mean[0]),
          state.covariance - gain * state.covariance.row(0)};
}

}  // namespace

FilteredPressure smooth_weather(std::span<const PressureSample> rows, const WeatherModel& model) {
  FilteredPressure out;
  std::vector<double> pressures;
  for (const PressureSample& row : rows) pressures.push_back(row.pressure_pa);
  const double measured_pa = rows.size() >= kRowsForNoise ? robust_sigma(pressures) : 0.0;
  out.sigma_pa = measured_pa > 0.0 ? measured_pa : model.default_sigma_pa;

  std::vector<Step> steps(rows.size());
  State state{Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
  state.covariance.diagonal() << squared(kLevelSigmaPa), squared(model.rate_sigma_pa_s);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double dt_s = i == 0 ? 0.0 : seconds_between(rows[i - 1].stamp_ns, rows[i].stamp_ns);
    steps[i].predicted = predict(state, dt_s, model, steps[i].transition);
    state = update(steps[i].predicted, pressures[i] - pressures.front(), squared(out.sigma_pa));
    steps[i].filtered = state;
  }
  std::vector<Eigen::Vector2d> smoothed(rows.size());
  smoothed.back() = state.mean;
  for (std::size_t i = rows.size() - 1; i-- > 0;) {
    const Step& next = steps[i + 1];
    const Eigen::Matrix2d gain =
        steps[i].filtered.covariance * next.transition.transpose() * next.predicted.covariance.inverse();
    smoothed[i] = steps[i].filtered.mean + gain * (smoothed[i + 1] - next.predicted.mean);
  }

  const auto add = [&](std::int64_t stamp_ns, double level_pa) {
    out.stamps_ns.push_back(stamp_ns);
    out.pressures_pa.push_back(pressures.front() + level_pa);
  };
  const auto extrapolation_ns = static_cast<std::int64_t>(1e9 * kExtrapolationS);
  add(rows.front().stamp_ns - extrapolation_ns, smoothed.front()[0] - smoothed.front()[1] * kExtrapolationS);
  for (std::size_t i = 0; i < rows.size(); ++i) add(rows[i].stamp_ns, smoothed[i][0]);
  add(rows.back().stamp_ns + extrapolation_ns, smoothed.back()[0] + smoothed.back()[1] * kExtrapolationS);
  if (rows.size() > 1) {
    out.interval_s =
        seconds_between(rows.front().stamp_ns, rows.back().stamp_ns) / static_cast<double>(rows.size() - 1);
  }
  return out;
}

}  // namespace isobar
