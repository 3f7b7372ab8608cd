// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/calibration_report.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/distribution.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/calibration_pictures.hpp"
#include "tools/report/html_page.hpp"

namespace isobar::report {

namespace {

/// One line of the table; the names of the paper where it has them.
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

std::string html_table(const CalibrationReport& report) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : kHead) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr></thead><tbody>\n";
  const ModelResult& offset = report.calibration.model(CompensationModel::kOffset);
  for (const ModelResult& result : report.calibration.models) {
    const Cells cells = row_of(result, offset);
    const char* open = result.model == report.chosen ? "<td class=\"best\"" : "<td";
    html += "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const bool fills = k + 1 == cells.size() && cells.size() < kHead.size();
      html += std::string(open) +
              (fills ? " colspan=\"" + std::to_string(kHead.size() - cells.size() + 1) + "\"" : "") + ">" +
              escaped(cells[k]) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string html_list(const std::vector<std::string>& lines) {
  std::string html = "<ul class=\"notes\">\n";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>\n";
  return html + "</ul>\n";
}

std::string tiles(const CalibrationReport& report) {
  const ModelResult& chosen = report.calibration.model(report.chosen);
  const ModelResult& offset = report.calibration.model(CompensationModel::kOffset);
  std::string html = "<ul class=\"tiles\">\n";
  html += tile("Model", model_name(report.chosen),
               std::to_string(free_coefficient_count(report.chosen)) + " coefficients, condition number " +
                   fixed(chosen.condition_number, 1));
  html += tile("Residual, median |r|", fixed(chosen.residual.median_abs_pa, 2) + " Pa",
               "after an offset alone " + fixed(offset.residual.median_abs_pa, 2) + " Pa");
  html += tile("Residual, rms", fixed(chosen.residual.rms_pa, 2) + " Pa",
               "after an offset alone " + fixed(offset.residual.rms_pa, 2) + " Pa");
  html += tile("On data it was not fitted to, rms", fixed(chosen.cross_validated_rms_pa, 2) + " Pa",
               "white noise of a sample " + fixed(white_noise_pa(chosen.residuals_pa), 2) + " Pa");
  return html + "</ul>\n";
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
      left_out += std::string(model_name(result.model)) + " was left out: " + result.left_out + "\n";
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
  std::string html = "<h1>" + escaped(report.title) + "</h1>\n<p class=\"lead\">" +
                     escaped(spans_text(calibration, report.recordings)) + ".</p>\n<p>Recommended is " +
                     escaped(calibration.reason) + ".</p>\n<div class=\"command\">" +
                     escaped(report.command) + "</div>\n" + tiles(report);
  html +=
      heading("Residual by model") +
      figure(
          residual_boxes(calibration), "Box plot of the residual by model",
          "|reference − compensated| of all samples. Thick line: median; box: quartiles; whiskers: 5th and "
          "95th percentiles.") +
      html_table(report) + "<p>rms, unseen: " + escaped(calibration.validation) + ".</p>\n";
  html += heading("Residual against temperature") +
          figure(residual_against_temperature(calibration, report.chosen, report.recordings),
                 "Residual against temperature, after an offset alone and after the model",
                 "Points: samples, evenly taken. Lines: medians of groups of equally many samples.");
  std::vector<std::string> warnings = calibration.warnings;
  warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
  if (!warnings.empty()) html += heading("To look at") + html_list(warnings);
  html += heading("How the data were read") + html_list(report.notes);
  return html_page(report.title, html);
}

}  // namespace isobar::report
