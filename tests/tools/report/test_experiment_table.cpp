// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/experiment_table.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

namespace isobar::test::test_experiment_table {

using namespace isobar::report;

namespace {

ExperimentCell cell(const char* method, double z_rpe, double largest_m, double ate_m, double final_m) {
  ExperimentCell cell;
  cell.method = method;
  cell.figures.z_rpe.median = z_rpe;
  cell.figures.largest_height_error_m = largest_m;
  cell.figures.ate_rms_m = ate_m;
  cell.figures.final_height_error_m = final_m;
  return cell;
}

ExperimentCell failed(const char* method) {
  ExperimentCell cell;
  cell.method = method;
  cell.failure = "the disk is full";
  return cell;
}

/// The line of a text that has all words in this order; empty: none.
std::string line_with(const std::string& text, std::initializer_list<const char*> words) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    std::size_t at = 0;
    for (const char* word : words) at = at == std::string::npos ? at : line.find(word, at);
    if (at != std::string::npos) return line;
    begin = end + 1;
  }
  return "";
}

std::vector<ExperimentResult> two_recordings() {
  return {
      {"hill-1", "", {cell("3dof", 0.0056, -0.75, 0.5, 0.03), cell("4dof", 0.0008, 0.23, 0.52, -0.2)}, ""},
      {"hill-2", "", {cell("3dof", 0.0050, -0.60, 0.4, 0.01), cell("4dof", 0.00525, 0.20, 0.5, -0.1)}, ""}};
}

}  // namespace

TEST_CASE("the table marks the best of each recording by magnitude") {
  const std::string text = experiment_table(two_recordings());
  CHECK_FALSE(line_with(text, {"hill-1", "3-DOF", "0.56 ", "0.750 ", "0.500*", "0.030*", "ok"}).empty());
  CHECK_FALSE(line_with(text, {"4-DOF", "0.08*", "0.230*", "0.520 ", "0.200 ", "ok"}).empty());
}

TEST_CASE("below, each method has its medians and counts the recordings within 1.1 times the best") {
  const std::string text = experiment_table(two_recordings());
  const std::string medians = text.substr(text.find("all recordings"));
  CHECK_FALSE(
      line_with(medians, {"3-DOF", "median", "0.53 ", "0.675 ", "0.450 ", "0.020 ", "0 of 2"}).empty());
  // 4-DOF: z-RPE best in one and 5 % above in the other; ATE 4 % above in one, 25 % in the other.
  const std::size_t four = medians.find("4-DOF");
  const std::string near = line_with(medians.substr(four), {"within 1.1 x best"});
  CHECK_FALSE(line_with(near, {"within 1.1 x best", " 2 ", " 2 ", " 1 ", " 0"}).empty());
}

TEST_CASE("a failed method is listed with its message, spoils no median and has no figures") {
  std::vector<ExperimentResult> results = two_recordings();
  results[1].cells[1] = failed("4dof");
  results.push_back({"moulin-1", "the folder cannot be written", {}, ""});
  results[0].cells[0].figures.verdict.kind = evaluation::VerdictKind::kLost;
  const std::string text = experiment_table(results);
  CHECK_FALSE(line_with(text, {"hill-2, 4dof: the disk is full"}).empty());
  CHECK_FALSE(line_with(text, {"moulin-1: the folder cannot be written"}).empty());
  CHECK_FALSE(line_with(text, {"hill-1", "3-DOF", "LOST"}).empty());
  CHECK_FALSE(line_with(text, {"4-DOF", "-", "-", "-", "-", "FAILED"}).empty());
  const std::string medians = text.substr(text.find("all recordings"));
  CHECK_FALSE(
      line_with(medians, {"4-DOF", "median", "0.08 ", "0.230 ", "0.520 ", "0.200 ", "1 of 2"}).empty());
  const std::string json = experiment_json(results, "isobar experiment all");
  CHECK(json.find("\"message\": \"the disk is full\"") != std::string::npos);
  CHECK(json.find("\"command\": \"isobar experiment all\"") != std::string::npos);
}

}  // namespace isobar::test::test_experiment_table
