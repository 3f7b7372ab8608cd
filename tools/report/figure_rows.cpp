// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/figure_rows.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

using evaluation::MethodFigures;

constexpr double kPercent = 100.0;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kDegreesPer100M = 100.0 * kDegrees;

/// Share of poses within an ellipsoid; neither more nor less than 95 % is better.
constexpr FigureRow within_95(const char* label, const char* key,
                              double (*value)(const MethodFigures& figures)) {
  return {"Covariance", label, "% of poses", key, nullptr, 1, kPercent, false, false, false, value};
}

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
    FigureRow{"Height", "Floors after the first minute, mean error", "m", "floors_after_1_min_mean_m",
              nullptr, 3, 1.0, false, true, false,
              [](const MethodFigures& f) { return f.settled_floors_mean_m; }},
    FigureRow{"Height", "Floors after the first minute, largest error", "m", "floors_after_1_min_worst_m",
              nullptr, 3, 1.0, false, true, false,
              [](const MethodFigures& f) { return f.settled_floors_worst_m; }},
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
    FigureRow{"Covariance", "Normalised error squared (NEES) / 6, mean", "", "nees_mean", nullptr, 2, 1.0,
              false, false, false, [](const MethodFigures& f) { return f.consistency.nees; }},
    within_95("Within the 95 % ellipsoid", "within_95_all",
              [](const MethodFigures& f) { return f.consistency.within_95; }),
    within_95("x, y, z within their 95 % ellipsoid", "within_95_position",
              [](const MethodFigures& f) { return f.consistency.within_95_position; }),
    within_95("roll, pitch, yaw within their 95 % ellipsoid", "within_95_orientation",
              [](const MethodFigures& f) { return f.consistency.within_95_orientation; }),
    within_95("x within 1.96 sigma", "within_95_x",
              [](const MethodFigures& f) { return f.consistency.within_95_component[0]; }),
    within_95("y within 1.96 sigma", "within_95_y",
              [](const MethodFigures& f) { return f.consistency.within_95_component[1]; }),
    within_95("z within 1.96 sigma", "within_95_z",
              [](const MethodFigures& f) { return f.consistency.within_95_component[2]; }),
    within_95("roll within 1.96 sigma", "within_95_roll",
              [](const MethodFigures& f) { return f.consistency.within_95_component[3]; }),
    within_95("pitch within 1.96 sigma", "within_95_pitch",
              [](const MethodFigures& f) { return f.consistency.within_95_component[4]; }),
    within_95("yaw within 1.96 sigma", "within_95_yaw",
              [](const MethodFigures& f) { return f.consistency.within_95_component[5]; }),
    FigureRow{"Covariance", "Longest time silently wrong", "s", "longest_silent_s", nullptr, 1, 1.0, false,
              true, false, [](const MethodFigures& f) { return f.consistency.longest_silent_s; }},
    FigureRow{"Map", "Points within 5 cm of a true surface", "%", "map_within_5_cm", nullptr, 2, kPercent,
              false, true, true, [](const MethodFigures& f) { return f.map.within_5_cm; }},
    FigureRow{"Map", "Points more than 20 cm off", "%", "map_beyond_20_cm", nullptr, 2, kPercent, false, true,
              false, [](const MethodFigures& f) { return f.map.beyond_20_cm; }},
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
