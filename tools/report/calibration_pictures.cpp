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

constexpr std::size_t kMaxDrawnPoints = 1'500;  // per model: more would only enlarge the file
constexpr std::size_t kGroups = 16;             // of samples, one median each
constexpr double kMedianLinePx = 2.6;

// One per model. Palette of Okabe and Ito (2008), as in the other reports.
constexpr std::array<const char*, 7> kColours = {"#6b7280", "#9ca3af", "#d55e00", "#0072b2",
                                                 "#009e73", "#b07d00", "#aa3a86"};

const char* colour_of(CompensationModel model) { return kColours[static_cast<std::size_t>(model)]; }

struct Cloud {
  std::string name;
  std::string colour;
  std::vector<Point> points;  ///< x: temperature [degC], y: residual [Pa]; ascending x
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

/// Median residual of each of kGroups groups of equally many samples.
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

/// Range of the residuals from the 0.5th to the 99.5th percentile: a few spikes must not flatten the picture.
Range residual_range(const std::vector<Cloud>& clouds) {
  std::vector<double> residuals;
  for (const Cloud& cloud : clouds) {
    for (const Point& point : cloud.points) residuals.push_back(point.y);
  }
  std::sort(residuals.begin(), residuals.end());
  return padded({quantile(residuals, 0.005), quantile(residuals, 0.995)}, 0.06, 0.1);
}

void draw_points(Picture& picture, const Cloud& cloud, const Axes& axes) {
  const std::size_t stride = cloud.points.size() / kMaxDrawnPoints + 1;
  for (std::size_t k = 0; k < cloud.points.size(); k += stride) {
    const Point& point = cloud.points[k];
    picture.circle({axes.x(point.x), axes.y(point.y)}, 1.6, cloud.colour, {cloud.colour, 0.0, "", 0.0});
  }
}

/// A line through the medians with a white outline, which keeps it visible over the points.
void draw_medians(Picture& picture, const Cloud& cloud, const Axes& axes) {
  std::vector<Point> line;
  for (const Point& median : medians_of(cloud)) line.push_back({axes.x(median.x), axes.y(median.y)});
  picture.polyline(line, {"#ffffff", 5.0});
  picture.polyline(line, {cloud.colour, kMedianLinePx});
}

}  // namespace

std::string calibration_row_name(CompensationModel model) {
  if (model == CompensationModel::kNone) return "A'_m, as it is";
  if (model == CompensationModel::kOffset) return "A'_m + offset";
  return std::string(kCompensationModelNames.name(model));
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
  Picture picture(1040.0, 420.0);
  std::vector<LegendEntry> legend;
  legend.reserve(clouds.size());
  for (const Cloud& cloud : clouds) legend.push_back({cloud.name, {cloud.colour, kMedianLinePx}});
  const Box frame = frame_below_legend(picture, legend, 8.0);
  const Range temperatures = padded({calibration.range.lowest_c, calibration.range.highest_c}, 0.02, 1.0);
  const Axes axes{frame, Scale::linear(temperatures, frame.x, frame.right(), kXTickPx),
                  Scale::linear(residual_range(clouds), frame.bottom(), frame.y, kYTickPx),
                  "temperature of the sensor [degC]", "reference − compensated [Pa]"};
  draw_axes(picture, axes);
  picture.begin_clip(frame, "temperature");
  picture.line({frame.x, axes.y(0.0)}, {frame.right(), axes.y(0.0)}, {"#6b7280", 1.0});
  for (const Cloud& cloud : clouds) draw_points(picture, cloud, axes);
  for (const Cloud& cloud : clouds) draw_medians(picture, cloud, axes);
  picture.end_clip();
  return picture;
}

}  // namespace isobar::report
