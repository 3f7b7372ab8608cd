// SPDX-License-Identifier: BSD-3-Clause
#include "tools/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "core/statistics/distribution.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/figure_rows.hpp"
#include "tools/report/number_text.hpp"
#include "tools/report/provenance.hpp"

namespace isobar::tools {

namespace {

using Json = nlohmann::ordered_json;

/// As the figure is shown; an error counts by its magnitude.
double size_of(const report::FigureRow& row, const evaluation::MethodFigures& figures) {
  const double value = row.scale * row.value(figures);
  return row.is_signed ? std::abs(value) : value;
}

ComparisonVerdict verdict_on(const PairedDifference& difference, bool larger_is_better) {
  if (difference.count < 2) return ComparisonVerdict::kUnknown;
  if (!difference.is_clear()) return ComparisonVerdict::kWithinScatter;
  return (difference.mean > 0.0) == larger_is_better ? ComparisonVerdict::kBetter : ComparisonVerdict::kWorse;
}

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::vector<ComparedFigure> compare_figures(const std::vector<ComparedRecording>& recordings) {
  std::vector<ComparedFigure> all;
  for (const report::FigureRow& row : report::figure_rows()) {
    if (!row.is_ranked) continue;
    std::vector<double> first;
    std::vector<double> second;
    for (const ComparedRecording& recording : recordings) {
      const double a = size_of(row, recording.first);
      const double b = size_of(row, recording.second);
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      first.push_back(a);
      second.push_back(b);
    }
    if (first.empty()) continue;
    const PairedDifference difference = paired_difference(first, second);
    all.push_back({std::string(row.group) + ": " + row.label, row.unit, row.decimals, median(first),
                   median(second), difference, verdict_on(difference, row.larger_is_better),
                   row.larger_is_better});
  }
  return all;
}

const char* verdict_word(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::kBetter:
      return "better";
    case ComparisonVerdict::kWorse:
      return "worse";
    case ComparisonVerdict::kWithinScatter:
      return "within scatter";
    case ComparisonVerdict::kUnknown:
      return "one recording";
  }
  return "";
}

namespace {

/// For the reader of a table: one recording shows what B is there, though not what it is elsewhere.
std::string table_word(const ComparedFigure& figure) {
  if (figure.difference.mean == 0.0 && !(figure.difference.margin > 0.0)) return "the same";
  if (figure.verdict != ComparisonVerdict::kUnknown) return verdict_word(figure.verdict);
  return (figure.difference.mean > 0.0) == figure.larger_is_better ? "better here" : "worse here";
}

std::size_t count_of(const std::vector<ComparedFigure>& figures, const std::string& word) {
  return static_cast<std::size_t>(std::count_if(figures.begin(), figures.end(), [&](const auto& figure) {
    return table_word(figure).starts_with(word);
  }));
}

}  // namespace

std::string comparison_summary(const std::vector<ComparedFigure>& figures) {
  const bool is_single = !figures.empty() && figures.front().verdict == ComparisonVerdict::kUnknown;
  std::string text = "B is better in " + std::to_string(count_of(figures, "better")) + " of " +
                     std::to_string(figures.size()) + " figures, worse in " +
                     std::to_string(count_of(figures, "worse")) + ", the same in " +
                     std::to_string(count_of(figures, "the same"));
  if (is_single) {
    return text +
           ". One recording says nothing of scatter: compare configurations on several, or with --seeds.";
  }
  return text + "; in " + std::to_string(count_of(figures, "within")) +
         " the difference is within the scatter of the recordings.";
}

std::string comparison_table(const std::vector<ComparedFigure>& figures) {
  std::vector<std::vector<std::string>> rows{{"figure", "unit", "A", "B", "B - A", "+- (95 %)", "B is"}};
  for (const ComparedFigure& figure : figures) {
    const auto text = [&](double value) {
      return std::isfinite(value) ? report::fixed(value, figure.decimals + 1) : "-";
    };
    rows.push_back({figure.label, "[" + figure.unit + "]", text(figure.first_median),
                    text(figure.second_median), text(figure.difference.mean), text(figure.difference.margin),
                    table_word(figure)});
  }
  return report::aligned_rows(rows);
}

std::string comparison_json(const std::vector<ComparedFigure>& figures,
                            const std::vector<ComparedRecording>& recordings, const std::string& command) {
  Json json{{"made_by", report::provenance_line()}, {"command", command}, {"figures", Json::array()}};
  for (const ComparedFigure& figure : figures) {
    json["figures"].push_back({{"figure", figure.label},
                               {"unit", figure.unit},
                               {"a_median", json_number(figure.first_median)},
                               {"b_median", json_number(figure.second_median)},
                               {"difference_mean", json_number(figure.difference.mean)},
                               {"difference_margin_95", json_number(figure.difference.margin)},
                               {"recordings", figure.difference.count},
                               {"verdict", verdict_word(figure.verdict)}});
  }
  for (const ComparedRecording& recording : recordings) {
    Json of_recording{{"recording", recording.name}};
    for (const report::FigureRow& row : report::figure_rows()) {
      of_recording["a"][row.key] = json_number(row.value(recording.first));
      of_recording["b"][row.key] = json_number(row.value(recording.second));
    }
    json["recordings"].push_back(std::move(of_recording));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace isobar::tools
