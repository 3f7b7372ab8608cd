// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/calibration_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/statistics/distribution.hpp"
namespace isobar::report {

namespace {

constexpr std::size_t kMaxDrawnPoints = 1'500;  // per model: more would only enlarge the file
constexpr std::size_t kGroups = 16;             // of samples, one median each
constexpr double kMedianLinePx = 2.6;

// One per model. Palette of Okabe and Ito (2008), as in the other reports.
constexpr std::array<const char*, 7> kColours = {"#6b7280", "#9ca3af", "#d55e00", "#0072b2",
                                                 "#009e73", "#b07d00", "#aa3a86"};

const char* colour_of(CompensationModel model) { return kColours[static_cast<std::size_t>(model)]; }

struct Point {
  double temperature_c = 0.0;
  double residual_pa = 0.0;
};

struct Cloud {
  std::string name;
  std::string colour;
  std::vector<Point> points;  ///< ascending temperature
};

Cloud cloud_of(const ModelResult& result, std::span<const CalibrationRecording> recordings) {
  Cloud cloud{calibration_row_name(result.model), colour_of(result.model), {}};
  std::size_t k = 0;
  for (const CalibrationRecording& recording : recordings) {
    for (const CalibrationPair& pair : recording.pairs) {
      cloud.points.push_back({pair.temperature_c, result.residuals_pa[k++]});
    }
  }
  std::stable_sort(cloud.points.begin(), cloud.points.end(),
                   [](const Point& a, const Point& b) { return a.temperature_c < b.temperature_c; });
  return cloud;
}

/// Median residual of each of kGroups groups of equally many samples.
std::vector<Point> medians_of(const Cloud& cloud) {
  std::vector<Point> medians;
  const std::size_t count = cloud.points.size();
  for (std::size_t g = 0; g < kGroups; ++g) {
    const std::size_t begin = count * g / kGroups;
    const std::size_t end = count * (g + 1) / kGroups;
    if (begin == end) continue;
    std::vector<double> residuals;
    for (std::size_t k = begin; k < end; ++k) residuals.push_back(cloud.points[k].residual_pa);
    std::sort(residuals.begin(), residuals.end());
    medians.push_back({cloud.points[(begin + end) / 2].temperature_c, quantile(residuals, 0.5)});
  }
  return medians;
}

/// Widened to at least `least` around its middle, then by `share` of its width at both ends.
std::array<double, 2> padded(double low, double high, double share, double least) {
  const double width = std::max(high - low, least);
  const double middle = 0.5 * (low + high);
  return {middle - (0.5 + share) * width, middle + (0.5 + share) * width};
}

/// Range of the residuals from the 0.5th to the 99.5th percentile: a few spikes must not flatten the picture.
std::array<double, 2> residual_range(const std::vector<Cloud>& clouds) {
  std::vector<double> residuals;
  for (const Cloud& cloud : clouds) {
    for (const Point& point : cloud.points) residuals.push_back(point.residual_pa);
  }
  std::sort(residuals.begin(), residuals.end());
  return padded(quantile(residuals, 0.005), quantile(residuals, 0.995), 0.06, 0.1);
}

Dots dots_of(const Cloud& cloud) {
  Dots dots{cloud.colour, {}, {}};
  const std::size_t stride = cloud.points.size() / kMaxDrawnPoints + 1;
  for (std::size_t k = 0; k < cloud.points.size(); k += stride) {
    dots.x.push_back(cloud.points[k].temperature_c);
    dots.y.push_back(cloud.points[k].residual_pa);
  }
  return dots;
}

Curve median_curve(const Cloud& cloud) {
  Curve curve{cloud.name, {cloud.colour, kMedianLinePx}, {}, {}};
  for (const Point& median : medians_of(cloud)) {
    curve.x.push_back(median.temperature_c);
    curve.y.push_back(median.residual_pa);
  }
  return curve;
}

}  // namespace

std::string calibration_row_name(CompensationModel model) {
  if (model == CompensationModel::kNone) return "A'_m, as it is";
  if (model == CompensationModel::kOffset) return "A'_m + offset";
  return std::string(kCompensationModelNames.name(model));
}

BoxChart residual_boxes(const Calibration& calibration) {
  BoxChart chart;
  chart.x_label = "|reference − compensated| [Pa]";
  chart.unit = "Pa";
  for (const ModelResult& result : calibration.models) {
    std::vector<double> absolutes;
    for (const double r : result.residuals_pa) absolutes.push_back(std::abs(r));
    chart.rows.push_back(
        {calibration_row_name(result.model), colour_of(result.model), summarize(std::move(absolutes))});
  }
  return chart;
}

CurveChart residual_against_temperature(const Calibration& calibration, CompensationModel chosen,
                                        std::span<const CalibrationRecording> recordings) {
  std::vector<Cloud> clouds{cloud_of(calibration.model(CompensationModel::kOffset), recordings)};
  if (chosen > CompensationModel::kOffset) clouds.push_back(cloud_of(calibration.model(chosen), recordings));
  CurveChart chart;
  chart.x_label = "temperature of the sensor [degC]";
  chart.y_label = "reference − compensated [Pa]";
  chart.x_unit = "degC";
  chart.y_unit = "Pa";
  chart.x_range = padded(calibration.range.lowest_c, calibration.range.highest_c, 0.02, 1.0);
  chart.y_range = residual_range(clouds);
  for (const Cloud& cloud : clouds) chart.dots.push_back(dots_of(cloud));
  for (const Cloud& cloud : clouds) chart.curves.push_back(median_curve(cloud));
  return chart;
}

}  // namespace isobar::report
