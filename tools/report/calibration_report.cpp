// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/calibration_report.hpp"

#include <algorithm>
#include <cmath>

#include "core/calibration/still_period.hpp"
#include "core/statistics/distribution.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/calibration_charts.hpp"
#include "tools/report/html_page.hpp"

namespace isobar::report {

namespace {

/// One row of the table, with the paper's name of the model.
Cells row_of(const ModelResult& result, const ModelResult& offset) {
  Cells cells{calibration_row_name(result.model), std::to_string(free_coefficient_count(result.model))};
  if (!result.left_out.empty()) {
    cells.push_back("left out: " + result.left_out);
    return cells;
  }
  for (const double value : {result.residual.median_abs_pa, result.residual.sd_pa, result.residual.p95_abs_pa,
                             result.residual.rms_pa, result.cross_validated_rms_pa}) {
    cells.push_back(fixed(value, 2));
  }
  cells.push_back(fixed(result.condition_number, 1));
  cells.push_back(fixed(100.0 * result.residual.rms_pa / offset.residual.rms_pa, 0) + " %");
  return cells;
}

const Cells kHead{"model",       "coefficients", "median |r|",     "sd", "p95 |r|", "rms",
                  "rms, unseen", "condition",    "of offset's rms"};

std::string spans_text(const Calibration& calibration, std::span<const CalibrationRecording> recordings) {
  const CalibratedRange& range = calibration.range;
  const auto used =
      std::count_if(recordings.begin(), recordings.end(),
                    [](const CalibrationRecording& recording) { return !recording.pairs.empty(); });
  return std::to_string(calibration.pair_count) + " samples in " + std::to_string(used) +
         (used == 1 ? " recording" : " recordings") + ", " + fixed(range.lowest_c, 1) + " to " +
         fixed(range.highest_c, 1) + " degC (" + fixed(range.highest_c - range.lowest_c, 1) + " K), " +
         fixed(0.01 * range.lowest_pa, 1) + " to " + fixed(0.01 * range.highest_pa, 1) + " hPa (" +
         fixed(0.01 * (range.highest_pa - range.lowest_pa), 1) + " hPa)";
}

/// The row of a model that could not be fitted ends with a cell that spans the figures.
std::vector<TableCell> html_row(const ModelResult& result, const CalibrationReport& report) {
  const std::string css_class = result.model == report.chosen ? "best" : "";
  std::vector<TableCell> row;
  for (const std::string& text : row_of(result, report.calibration.model(CompensationModel::kOffset))) {
    row.push_back({text, css_class});
  }
  row.back().columns = kHead.size() + 1 - row.size();
  return row;
}

std::string models_table(const CalibrationReport& report) {
  std::vector<std::vector<TableCell>> rows;
  for (const ModelResult& result : report.calibration.models) rows.push_back(html_row(result, report));
  return html_table(kHead, rows);
}

std::string tiles(const CalibrationReport& report) {
  const ModelResult& chosen = report.calibration.model(report.chosen);
  const ModelResult& offset = report.calibration.model(CompensationModel::kOffset);
  return tile_row({{"Model", std::string(kCompensationModelNames.name(report.chosen)),
                    std::to_string(free_coefficient_count(report.chosen)) +
                        " coefficients, condition number " + fixed(chosen.condition_number, 1)},
                   {"Residual, median |r|", fixed(chosen.residual.median_abs_pa, 2) + " Pa",
                    "with an offset alone " + fixed(offset.residual.median_abs_pa, 2) + " Pa"},
                   {"Residual, rms", fixed(chosen.residual.rms_pa, 2) + " Pa",
                    "with an offset alone " + fixed(offset.residual.rms_pa, 2) + " Pa"},
                   {"Cross-validated residual, rms", fixed(chosen.cross_validated_rms_pa, 2) + " Pa",
                    "white noise of a sample " + fixed(robust_sigma(chosen.residuals_pa), 2) + " Pa"}});
}

}  // namespace

std::string calibration_table(const Calibration& calibration,
                              std::span<const CalibrationRecording> recordings) {
  std::vector<Cells> rows{kHead, {"", "", "[Pa]", "[Pa]", "[Pa]", "[Pa]", "[Pa]", "", ""}};
  std::string left_out;
  const ModelResult& offset = calibration.model(CompensationModel::kOffset);
  for (const ModelResult& result : calibration.models) {
    Cells cells = row_of(result, offset);
    if (!result.left_out.empty()) {
      left_out += std::string(kCompensationModelNames.name(result.model)) +
                  " was left out: " + result.left_out + "\n";
    } else {
      rows.push_back(std::move(cells));
    }
  }
  std::string text = spans_text(calibration, recordings) + "\n\n" + aligned_rows(rows) + left_out +
                     "\nr: reference minus compensated. rms, unseen: " + calibration.validation + ".\n";
  return text + "Recommended is " + calibration.reason + ".\n";
}

std::string render_calibration_report(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  std::vector<std::string> warnings = calibration.warnings;
  warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
  std::string html =
      page_head(report.title, spans_text(calibration, report.recordings) + ".", report.command) +
      paragraph("Recommended is " + calibration.reason + ".") + tiles(report);
  html += heading("Residual by model") +
          chart_figure(
              chart_json(residual_boxes(calibration)), "Box plot of the residual by model",
              "|reference − compensated| of all samples. Thick line: median; box: quartiles; whiskers: 5th "
              "and 95th percentiles.") +
          models_table(report) + paragraph("rms, unseen: " + calibration.validation + ".");
  html +=
      heading("Residual against temperature") +
      chart_figure(chart_json(residual_against_temperature(calibration, report.chosen, report.recordings)),
                   "Residual against temperature, with an offset alone and with the chosen model",
                   "Points: every n-th sample. Lines: medians of groups of equally many samples.");
  if (!warnings.empty()) html += heading("Warnings") + bullet_list(warnings);
  html += heading("How the logs were read") + bullet_list(report.notes);
  return html_page(report.title, html);
}

}  // namespace isobar::report
