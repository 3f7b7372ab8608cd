// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/files/text_file.hpp"
#include "tests/run/evaluation/runs.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/report/well_formed.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/provenance.hpp"
#include "tools/report/report.hpp"
#include "tools/report/report_data.hpp"

namespace isobar::test::test_report {

using namespace isobar::report;
using isobar::test::is_well_formed;
using isobar::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The page's body without what stands in its scripts and styles.
std::string markup_of(const std::string& html) {
  std::string body = html.substr(html.find("<body>"));
  body.erase(body.find("</html>"));
  for (const std::string tag : {"script", "style"}) {
    for (std::size_t at = body.find("<" + tag); at != std::string::npos; at = body.find("<" + tag, at + 1)) {
      const std::size_t begin = body.find('>', at) + 1;
      body.erase(begin, body.find("</" + tag + ">", begin) - begin);
    }
  }
  return body;
}

}  // namespace

TEST_CASE("the report is one well-formed file with every section that loads nothing") {
  const TemporaryFolder folder;
  const ReportInput input{"Title <&>", "What \"it\" is", "isobar evaluate a b", two_methods(folder.path())};
  const std::string html = render_report(input);
  CHECK(is_well_formed(markup_of(html)));
  CHECK(contains(html, "<h1>Title &lt;&amp;&gt;</h1>"));
  CHECK(contains(html, "isobar evaluate a b"));
  CHECK_FALSE(contains(markup_of(html), "src="));
  // An empty icon, so that a browser asks nobody for one.
  const std::string no_icon = "<link rel=\"icon\" href=\"data:,\">";
  const std::size_t link = html.find("<link");
  CHECK(html.compare(link, no_icon.size(), no_icon) == 0);
  CHECK(html.find("<link", link + 1) == std::string::npos);
  CHECK_FALSE(contains(html, "@import"));
  CHECK_FALSE(contains(html, "href=\"http"));
  for (const char* section : {"Relative error on z", "Time per scan", "All figures", "Height of each floor",
                              "Definitions", "Altimeter"}) {
    CHECK_MESSAGE(contains(html, section), section);
  }
}

TEST_CASE(
    "the report shows the altimeter's bias where a method estimates it, and when which barometer drifts") {
  const TemporaryFolder folder;
  evaluation::EvaluatedRun run = two_methods(folder.path());
  const std::string without = render_report({"T", "", "", run});
  CHECK_FALSE(contains(without, "Altimeter against the map"));
  std::vector<evaluation::StatusRow>& status = run.methods.back().status;
  status.clear();
  for (int i = 0; i < 100; ++i) {
    evaluation::StatusRow& row = status.emplace_back();
    row.stamp_ns = 1'000'000'000LL * (i + 1);
    row.altimeter_bias_m = 0.01 * i;
    row.altimeter_bias_sd_m = 0.05;
    row.altimeter_innovation_m = i == 40 ? -0.37 : 0.01;
    row.altimeter_drifts = i >= 50 && i < 70 ? "robot" : "none";
    row.altimeter_faulty = i >= 50;
    row.airflow_s2_m = 0.017;
    row.airflow_sd_s2_m = 0.0012;
  }
  const std::string html = render_report({"T", "", "", run});
  CHECK(contains(html, "Altimeter against the map"));
  CHECK(contains(html, "0.37 m at 40.0 s"));
  CHECK(contains(html, "robot drifts since 50.0 s until 69.0 s, faulty since 70.0 s until 99.0 s"));
  CHECK(contains(html, "17.0 mm per (m/s)², 1 sigma 1.2."));
  CHECK(contains(html, "\"areas\":[{"));
  CHECK(is_well_formed(markup_of(html)));
}

TEST_CASE("trajectories without segments, status and map give a report that names what is missing") {
  const TemporaryFolder folder;
  const fs::path reference = folder.path() / "r.tum";
  files::write_text_file(reference, tum_text(isobar::test::straight(30.0, 0.1)));
  SUBCASE("a whole run") {
    files::write_text_file(folder.path() / "e.tum", tum_text(isobar::test::straight(30.0, 0.1)));
  }
  SUBCASE("a single pose") {
    files::write_text_file(folder.path() / "e.tum", tum_text(isobar::test::straight(0.0, 0.1)));
  }
  const ReportInput input{
      "t", "", "",
      evaluation::evaluate_methods(evaluation::load_reference(reference), {{"", folder.path() / "e.tum"}})};
  CHECK(contains(input.run.notes.at(0), "No flat segments"));
  const std::string html = render_report(input);
  CHECK(contains(html, "No flat segments"));
  CHECK_FALSE(contains(html, "Time per scan"));
  CHECK_FALSE(contains(html, "isobar-map-0\""));
  CHECK(is_well_formed(markup_of(html)));
}

TEST_CASE("the data of the report's curves are those of the evaluation, along ascending distances") {
  const TemporaryFolder folder;
  const evaluation::EvaluatedRun run = two_methods(folder.path());
  const auto json = nlohmann::json::parse(report_data_json(run));
  CHECK(json.at("altimeter").at("z_m").size() > 10);
  REQUIRE(json.at("methods").size() == run.methods.size());
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    const auto& method = json.at("methods").at(i);
    const auto distance_m = method.at("distance_m").get<std::vector<double>>();
    REQUIRE(distance_m.size() > 10);
    CHECK(std::is_sorted(distance_m.begin(), distance_m.end(), std::less_equal<>()));
    for (const char* column : {"x_m", "y_m", "z_m", "error_m"})
      CHECK(method.at(column).size() == distance_m.size());
    const auto& last = run.methods[i].evaluation.pairs.back();
    // Rounded to millimetres.
    CHECK(std::abs(method.at("error_m").back().get<double>() -
                   run.methods[i].evaluation.figures.final_height_error_m) < 0.02);
    CHECK(std::abs(distance_m.back() - last.distance_m) < 0.2);
    CHECK(method.at("verdict") == evaluation::verdict_word(run.methods[i].evaluation.figures.verdict.kind));
  }
}

TEST_CASE("settings that differ between the runs are named, equal ones are not") {
  const TemporaryFolder folder;
  const evaluation::EvaluatedRun run = two_methods(folder.path());
  const auto write = [&](std::size_t method, const std::string& text) {
    files::write_text_file(run.methods[method].source / "settings.toml", text);
  };
  REQUIRE(fs::is_directory(run.methods[0].source));
  REQUIRE(fs::is_directory(run.methods[1].source));
  write(0, "method = \"4dof\"\n[registration]\nmax_range_m = 50.0\n");
  write(1, "method = \"3dof\"\n[registration]\nmax_range_m = 50.0\n");
  const std::vector<DifferingSetting> differing = differing_settings(run);
  REQUIRE(differing.size() == 1);
  CHECK(differing[0].key == "method");
  CHECK(differing[0].values == std::vector<std::string>{"\"4dof\"", "\"3dof\""});
  CHECK(contains(render_report({"T", "", "", run}), "Settings that differ"));
  write(1, "nonsense");
  CHECK(differing_settings(run).empty());
}

TEST_CASE("a reference at rest gives no figure that divides by distance") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "r.tum";
  files::write_text_file(file, "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  const ReportInput input{"t", "", "",
                          evaluation::evaluate_methods(evaluation::load_reference(file), {{"same", file}})};
  CHECK(std::isnan(input.run.methods[0].evaluation.figures.ate_share));
  CHECK(contains(figures_json(input.run), "\"ate_share_of_distance\": null"));
  CHECK(contains(render_report(input), "All figures"));
}

}  // namespace isobar::test::test_report
