// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/figure_rows.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/report/svg.hpp"

namespace isobar::report {

namespace {

using evaluation::MethodFigures;

constexpr double kPercent = 100.0;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kDegreesPer100M = 100.0 * kDegrees;

constexpr std::array kRows{
    FigureRow{"Relative error on z over 5 m", "Median", "%", "z_rpe_median", "z-RPE med", 2, kPercent, false,
              true, false, [](const MethodFigures& f) { return f.z_rpe.median; }},
    FigureRow{"Relative error on z over 5 m", "Lower quartile", "%", "z_rpe_q25", nullptr, 2, kPercent, false,
              true, false, [](const MethodFigures& f) { return f.z_rpe.q25; }},
    FigureRow{"Relative error on z over 5 m", "Upper quartile", "%", "z_rpe_q75", nullptr, 2, kPercent, false,
              true, false, [](const MethodFigures& f) { return f.z_rpe.q75; }},
    FigureRow{"Relative error on z over 5 m", "95th percentile", "%", "z_rpe_p95", "z-RPE p95", 2, kPercent,
              false, true, false, [](const MethodFigures& f) { return f.z_rpe.p95; }},
    FigureRow{"Relative error on z over 5 m", "Windows", "", "z_rpe_windows", nullptr, 0, 1.0, false, false,
              false, [](const MethodFigures& f) { return static_cast<double>(f.z_rpe.count); }},
    FigureRow{"Height", "Final error", "m", "final_height_error_m", "dz final", 3, 1.0, true, true, false,
              [](const MethodFigures& f) { return f.final_height_error_m; }},
    FigureRow{"Height", "Largest error", "m", "largest_height_error_m", "dz max", 3, 1.0, true, true, false,
              [](const MethodFigures& f) { return f.largest_height_error_m; }},
    FigureRow{"Height", "Within 2 sigma of the estimate", "% of poses", "share_within_two_sigma", nullptr, 1,
              kPercent, false, false, false, [](const MethodFigures& f) { return f.sigma_share; }},
    FigureRow{"Position", "ATE, rms", "m", "ate_rms_m", "ATE rms", 3, 1.0, false, true, false,
              [](const MethodFigures& f) { return f.ate_rms_m; }},
    FigureRow{"Position", "ATE, largest", "m", "ate_max_m", "ATE max", 3, 1.0, false, true, false,
              [](const MethodFigures& f) { return f.ate_max_m; }},
    FigureRow{"Position", "ATE, rms over the distance", "%", "ate_share_of_distance", "ATE", 2, kPercent,
              false, true, false, [](const MethodFigures& f) { return f.ate_share; }},
    FigureRow{"Position", "RPE over 10 m, median", "%", "rpe_translation_median", "RPE 10 m", 2, kPercent,
              false, true, false, [](const MethodFigures& f) { return f.rpe_translation.median; }},
    FigureRow{"Position", "RPE over 10 m, 95th percentile", "%", "rpe_translation_p95", nullptr, 2, kPercent,
              false, true, false, [](const MethodFigures& f) { return f.rpe_translation.p95; }},
    FigureRow{"Heading and attitude", "RPE over 10 m, median", "deg/m", "rpe_rotation_median_deg_m",
              "RPE rot", 4, kDegrees, false, true, false,
              [](const MethodFigures& f) { return f.rpe_rotation_rad_m.median; }},
    FigureRow{"Heading and attitude", "RPE over 10 m, 95th percentile", "deg/m", "rpe_rotation_p95_deg_m",
              nullptr, 4, kDegrees, false, true, false,
              [](const MethodFigures& f) { return f.rpe_rotation_rad_m.p95; }},
    FigureRow{"Heading and attitude", "Yaw drift at the end", "deg", "yaw_drift_deg", "yaw end", 2, kDegrees,
              true, true, false, [](const MethodFigures& f) { return f.yaw_drift_rad; }},
    FigureRow{"Heading and attitude", "Yaw drift", "deg/100 m", "yaw_drift_deg_per_100m", "yaw drift", 2,
              kDegreesPer100M, false, true, false, [](const MethodFigures& f) { return f.yaw_drift_rad_m; }},
    FigureRow{"Run", "Time covered", "%", "coverage", "coverage", 2, kPercent, false, true, true,
              [](const MethodFigures& f) { return f.coverage; }},
    FigureRow{"Run", "Poses", "", "poses", nullptr, 0, 1.0, false, false, false,
              [](const MethodFigures& f) { return static_cast<double>(f.poses); }},
};

}  // namespace

std::span<const FigureRow> figure_rows() { return kRows; }

std::string shown(const FigureRow& row, const evaluation::MethodFigures& figures) {
  const double value = row.scale * row.value(figures);
  return row.is_signed ? fixed_signed(value, row.decimals) : fixed(value, row.decimals);
}

}  // namespace isobar::report
