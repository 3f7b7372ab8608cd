// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/experiment_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/statistics/distribution.hpp"
#include "tools/report/aligned_rows.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::report {

namespace {

using evaluation::MethodFigures;

/// A column of the table; the smallest magnitude is best.
struct Column {
  const char* heading;
  const char* unit;
  int decimals;
  double (*value)(const MethodFigures& figures);
};

constexpr std::array kColumns{
    Column{"z-RPE med", "%", 2, [](const MethodFigures& f) { return 100.0 * f.z_rpe.median; }},
    Column{"dz max", "m", 3, [](const MethodFigures& f) { return f.largest_height_error_m; }},
    Column{"ATE rms", "m", 3, [](const MethodFigures& f) { return f.ate_rms_m; }},
    Column{"dz end", "m", 3, [](const MethodFigures& f) { return f.final_height_error_m; }},
};
using Json = nlohmann::ordered_json;
using Sizes = std::array<double, kColumns.size()>;  // magnitudes, one a column; NaN: unknown

// "Never worse than the best": within a tenth of it.
constexpr double kNearBest = 1.1;

std::string plain_number(double value, int decimals) {
  return std::isfinite(value) ? fixed(value, decimals) : "-";
}

Sizes sizes_of(const ExperimentCell& cell) {
  Sizes sizes{};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    sizes[i] = cell.failure.empty() ? std::abs(kColumns[i].value(cell.figures))
                                    : std::numeric_limits<double>::quiet_NaN();
  }
  return sizes;
}

Sizes best_of(const ExperimentResult& result) {
  Sizes best{};
  best.fill(std::numeric_limits<double>::infinity());
  for (const ExperimentCell& cell : result.cells) {
    const Sizes sizes = sizes_of(cell);
    for (std::size_t i = 0; i < sizes.size(); ++i)
      best[i] = std::min(best[i], std::isnan(sizes[i]) ? best[i] : sizes[i]);
  }
  return best;
}

void add_recording(const ExperimentResult& result, std::vector<Cells>& rows) {
  if (!result.failure.empty()) rows.push_back({result.recording, "", "", "", "", "", "FAILED"});
  const Sizes best = best_of(result);
  for (const ExperimentCell& cell : result.cells) {
    const Sizes sizes = sizes_of(cell);
    Cells row{&cell == &result.cells.front() ? result.recording : "", evaluation::display_name(cell.method)};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const bool is_best = sizes[i] == best[i] && result.cells.size() > 1;
      row.push_back(plain_number(sizes[i], kColumns[i].decimals) + (is_best ? "*" : " "));
    }
    row.emplace_back(cell.failure.empty() ? evaluation::verdict_word(cell.figures.verdict.kind) : "FAILED");
    rows.push_back(std::move(row));
  }
}

/// A method over all recordings.
struct Summary {
  std::string method;
  std::array<std::vector<double>, kColumns.size()> sizes;
  std::array<int, kColumns.size()> near_best{};
  int recordings = 0;
  int lost = 0;
};

std::vector<Summary> summaries(const std::vector<ExperimentResult>& results) {
  std::vector<Summary> all;
  for (const ExperimentResult& result : results) {
    const Sizes best = best_of(result);
    for (const ExperimentCell& cell : result.cells) {
      auto summary =
          std::find_if(all.begin(), all.end(), [&](const Summary& one) { return one.method == cell.method; });
      if (summary == all.end()) summary = all.insert(all.end(), Summary{cell.method, {}, {}, 0, 0});
      ++summary->recordings;
      if (!cell.failure.empty() || !cell.figures.verdict.ok()) ++summary->lost;
      const Sizes sizes = sizes_of(cell);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (!std::isnan(sizes[i])) summary->sizes[i].push_back(sizes[i]);
        if (sizes[i] <= kNearBest * best[i]) ++summary->near_best[i];
      }
    }
  }
  return all;
}

Cells heading(const char* first, const char* second, const char* last) {
  Cells row{first, second};
  for (const Column& column : kColumns)
    row.push_back(std::string(column.heading) + " [" + column.unit + "] ");
  row.emplace_back(last);
  return row;
}

}  // namespace

std::string experiment_table(const std::vector<ExperimentResult>& results) {
  std::vector<Cells> rows{heading("recording", "method", "verdict")};
  for (const ExperimentResult& result : results) add_recording(result, rows);
  std::vector<Cells> medians{heading("all recordings", "", "not ok")};
  for (const Summary& summary : summaries(results)) {
    Cells medians_of{evaluation::display_name(summary.method), "median"};
    Cells near{"", "within 1.1 x best"};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      medians_of.push_back(plain_number(median(summary.sizes[i]), kColumns[i].decimals) + " ");
      near.push_back(std::to_string(summary.near_best[i]) + " ");
    }
    medians_of.push_back(std::to_string(summary.lost) + " of " + std::to_string(summary.recordings));
    near.emplace_back("");
    medians.push_back(std::move(medians_of));
    medians.push_back(std::move(near));
  }
  std::string text =
      aligned_rows(rows) + "* the best of a recording; heights without sign\n\n" + aligned_rows(medians);
  for (const ExperimentResult& result : results) {
    if (!result.failure.empty()) text += "\n" + result.recording + ": " + result.failure;
    for (const ExperimentCell& cell : result.cells) {
      if (!cell.failure.empty()) text += "\n" + result.recording + ", " + cell.method + ": " + cell.failure;
    }
  }
  return text + "\n";
}

std::string experiment_json(const std::vector<ExperimentResult>& results, const std::string& command) {
  Json json{{"command", command}, {"recordings", Json::array()}};
  for (const ExperimentResult& result : results) {
    Json one{{"name", result.recording}};
    one["figures"] = result.figures_json.empty() ? Json(nullptr) : Json::parse(result.figures_json);
    one["failures"] = Json::array();
    if (!result.failure.empty())
      one["failures"].push_back({{"method", nullptr}, {"message", result.failure}});
    for (const ExperimentCell& cell : result.cells) {
      if (cell.failure.empty()) continue;
      one["failures"].push_back({{"method", cell.method}, {"message", cell.failure}});
    }
    json["recordings"].push_back(std::move(one));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace isobar::report
