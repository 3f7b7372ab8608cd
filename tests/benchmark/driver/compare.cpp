// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/compare.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "core/statistics/distribution.hpp"

namespace isobar::bench {

namespace {

/// Appends the compared figures of one data set with their names: "registration, median ms".
void collect(const Json& data, std::vector<std::pair<std::string, double>>& figures) {
  const auto add = [&](const std::string& name, const Json& value) {
    if (value.is_number()) figures.emplace_back(name, value.get<double>());
  };
  const auto add_rows = [&](const Json& rows, const std::string& unit) {
    for (const auto& [key, row] : rows.items()) {
      if (!row.is_object()) continue;
      for (const char* figure : {"median", "p99", "mean"})
        add(std::string(key).append(", ").append(figure).append(unit), row[figure]);
    }
  };
  add_rows(data["ms"], " ms");
  add_rows(data["counters"], "");
  add_rows(data["allocations"], " allocations");
  if (data["growth"].is_object()) add("last tenth to first tenth", data["growth"]["mean_ratio"]);
  add("memory at the end, bytes", data["memory"]["end_bytes"]);
  add("cells", data["memory"]["cells"]);
  if (data["error"].is_object()) {
    add("error at the end, m", data["error"]["final_m"]);
    add("ATE rms, m", data["error"]["ate_rms_m"]);
  }
}

/// Medians of one figure over the runs, and its ratios over the pairs.
Json figure_json(const std::string& name, const std::vector<double>& a, const std::vector<double>& b) {
  Json row{{"figure", name}, {"a", median(a)}, {"b", median(b)}, {"ratio", nullptr}};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > 0.0) ratios.push_back(b[i] / a[i]);
  }
  if (ratios.size() == a.size()) {
    row["ratio"] = median(ratios);
    row["smallest"] = *std::min_element(ratios.begin(), ratios.end());
    row["largest"] = *std::max_element(ratios.begin(), ratios.end());
  }
  return row;
}

std::vector<Json> read_all(const std::vector<std::string>& files) {
  std::vector<Json> results;
  results.reserve(files.size());
  for (const std::string& file : files) results.push_back(read_json(file));
  return results;
}

/// Figures of data set `index` of every run: names[i] has values[i][run].
struct Series {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

Series series_of(const std::vector<Json>& runs, std::size_t index) {
  Series series;
  for (const Json& run : runs) {
    std::vector<std::pair<std::string, double>> figures;
    collect(run.at("data").at(index), figures);
    if (series.names.empty()) {
      for (const auto& figure : figures) series.names.push_back(figure.first);
      series.values.resize(figures.size());
    }
    if (figures.size() != series.names.size())
      throw DataError("the runs of one build have different figures");
    for (std::size_t i = 0; i < figures.size(); ++i) series.values[i].push_back(figures[i].second);
  }
  return series;
}

Json compare_data(const std::vector<Json>& a, const std::vector<Json>& b, std::size_t index) {
  const Json& name = a.front()["data"][index]["name"];
  if (b.front()["data"].size() <= index || b.front()["data"][index]["name"] != name) {
    throw DataError("the two builds were run on different data");
  }
  const Series of_a = series_of(a, index);
  const Series of_b = series_of(b, index);
  Json rows = Json::array();
  for (std::size_t i = 0; i < of_a.names.size(); ++i) {
    const auto found = std::find(of_b.names.begin(), of_b.names.end(), of_a.names[i]);
    if (found == of_b.names.end()) continue;  // figure of one build only
    rows.push_back(figure_json(of_a.names[i], of_a.values[i],
                               of_b.values[static_cast<std::size_t>(found - of_b.names.begin())]));
  }
  return {{"name", name}, {"pairs", a.size()}, {"figures", rows}};
}

}  // namespace

Json read_json(const std::string& file) {
  std::ifstream stream(file);
  try {
    return Json::parse(stream);
  } catch (const nlohmann::json::exception& error) {
    throw DataError(file + ": " + error.what());
  }
}

Json compare_results(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  if (a.size() != b.size()) throw UsageError("--a and --b: must name equally many files");
  const std::vector<Json> runs_a = read_all(a);
  const std::vector<Json> runs_b = read_all(b);
  try {
    Json result = Json::array();
    for (std::size_t i = 0; i < runs_a.front().at("data").size(); ++i)
      result.push_back(compare_data(runs_a, runs_b, i));
    return result;
  } catch (const nlohmann::json::exception& error) {
    throw DataError(a.front() + ", " + b.front() + ": no results of isobar_benchmark: " + error.what());
  }
}

void print_comparison(const Json& ratios) {
  for (const Json& data : ratios) {
    std::printf("\n%s, %zu pairs of runs\n", data["name"].get<std::string>().c_str(),
                data["pairs"].get<std::size_t>());
    std::printf("  %-46s%14s%14s%9s%18s\n", "", "A", "B", "B / A", "from … to");
    for (const Json& row : data["figures"]) {
      std::printf("  %-46s%14.5g%14.5g", row["figure"].get<std::string>().c_str(), row["a"].get<double>(),
                  row["b"].get<double>());
      if (row["ratio"].is_null()) {
        std::printf("%9s\n", "-");
      } else {
        std::printf("%9.3f%9.3f%8.3f\n", row["ratio"].get<double>(), row["smallest"].get<double>(),
                    row["largest"].get<double>());
      }
    }
  }
}

}  // namespace isobar::bench
