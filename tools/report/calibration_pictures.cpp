// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/calibration_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/statistics/distribution.hpp"
#include "tools/report/box_plot.hpp"
#include "tools/report/scale.hpp"

namespace isobar::report {

namespace {

constexpr double kWidth = 1040.0;
constexpr std::size_t kMostPoints = 1'500;
constexpr std::size_t kGroups = 16;

// Of Okabe and Ito (2008), as in the other reports.
constexpr std::array<const char*, 7> kColours = {"#6b7280", "#9ca3af", "#d55e00", "#0072b2",
                                                 "#009e73", "#b07d00", "#aa3a86"};

const char* colour_of(CompensationModel model) { return kColours[static_cast<std::size_t>(model)]; }

struct Cloud {
  std::string name;
  std::string colour;
  std::vector<Point> points;  ///< temperature, residual; by temperature
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
                   [](const Point& a, const Point& b) { return a.x < b.x; });
  return cloud;
}

/// Medians of equally many samples each.
std::vector<Point> medians_of(const Cloud& cloud) {
  std::vector<Point> medians;
  const std::size_t count = cloud.points.size();
  for (std::size_t g = 0; g < kGroups; ++g) {
    const std::size_t begin = count * g / kGroups;
    const std::size_t end = count * (g + 1) / kGroups;
    if (begin == end) continue;
    std::vector<double> residuals;
    for (std::size_t k = begin; k < end; ++k) residuals.push_back(cloud.points[k].y);
    std::sort(residuals.begin(), residuals.end());
    medians.push_back({cloud.points[(begin + end) / 2].x, quantile(residuals, 0.5)});
  }
  return medians;
}

/// Without the hundredth of the residuals that lies furthest out: a few spikes must not flatten the picture.
Range residual_range(const std::vector<Cloud>& clouds) {
  std::vector<double> residuals;
  for (const Cloud& cloud : clouds) {
    for (const Point& point : cloud.points) residuals.push_back(point.y);
  }
  std::sort(residuals.begin(), residuals.end());
  return padded({quantile(residuals, 0.005), quantile(residuals, 0.995)}, 0.06, 0.1);
}

}  // namespace

std::string calibration_row_name(CompensationModel model) {
  if (model == CompensationModel::kNone) return "A'_m, as it is";
  if (model == CompensationModel::kOffset) return "A'_m + offset";
  return model_name(model);
}

Picture residual_boxes(const Calibration& calibration) {
  BoxPlot plot;
  plot.x_label = "|reference − compensated| [Pa]";
  plot.unit = "Pa";
  for (const ModelResult& result : calibration.models) {
    std::vector<double> absolutes;
    for (const double r : result.residuals_pa) absolutes.push_back(std::abs(r));
    plot.rows.push_back(
        {calibration_row_name(result.model), colour_of(result.model), summarize(std::move(absolutes))});
  }
  return draw(plot);
}

Picture residual_against_temperature(const Calibration& calibration, CompensationModel chosen,
                                     std::span<const CalibrationRecording> recordings) {
  std::vector<Cloud> clouds{cloud_of(calibration.model(CompensationModel::kOffset), recordings)};
  if (chosen > CompensationModel::kOffset) clouds.push_back(cloud_of(calibration.model(chosen), recordings));
  Picture picture(kWidth, 420.0);
  std::vector<LegendEntry> legend;
  legend.reserve(clouds.size());
  for (const Cloud& cloud : clouds) legend.push_back({cloud.name, {cloud.colour, 2.6}});
  const double top = draw_legend(picture, {68.0, 0.0}, kWidth - 82.0, legend) + 8.0;
  const Box frame{68.0, top, kWidth - 82.0, 420.0 - top - 50.0};
  const Range temperatures = padded({calibration.range.lowest_c, calibration.range.highest_c}, 0.02, 1.0);
  const Axes axes{frame, Scale::linear(temperatures, frame.x, frame.right(), 90.0),
                  Scale::linear(residual_range(clouds), frame.bottom(), frame.y, 44.0),
                  "temperature of the sensor [degC]", "reference − compensated [Pa]"};
  draw_axes(picture, axes);
  picture.begin_clip(frame, "temperature");
  picture.line({frame.x, axes.y(0.0)}, {frame.right(), axes.y(0.0)}, {"#6b7280", 1.0});
  for (const Cloud& cloud : clouds) {
    const std::size_t every = cloud.points.size() / kMostPoints + 1;
    for (std::size_t k = 0; k < cloud.points.size(); k += every) {
      const Point& point = cloud.points[k];
      picture.circle({axes.x(point.x), axes.y(point.y)}, 1.6, cloud.colour, {cloud.colour, 0.0, "", 0.0});
    }
  }
  for (const Cloud& cloud : clouds) {
    std::vector<Point> line;
    for (const Point& median : medians_of(cloud)) line.push_back({axes.x(median.x), axes.y(median.y)});
    picture.polyline(line, {"#ffffff", 5.0});
    picture.polyline(line, {cloud.colour, 2.6});
  }
  picture.end_clip();
  return picture;
}

}  // namespace isobar::report
