// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/report/well_formed.hpp"
#include "tools/report/box_chart.hpp"
#include "tools/report/curve_chart.hpp"
#include "tools/report/html_page.hpp"
#include "tools/report/number_text.hpp"

namespace isobar::test::test_charts {

using namespace isobar::report;
using isobar::summarize;
using isobar::test::is_well_formed;
using nlohmann::json;

TEST_CASE("numbers have a decimal dot, no negative zero, and a dash for NaN") {
  CHECK(fixed(3.14159, 2) == "3.14");
  CHECK(fixed(-0.001, 2) == "0.00");
  CHECK(fixed(NAN, 2) == "\u2013");
  CHECK(fixed_signed(1.5, 1) == "+1.5");
  CHECK(fixed_signed(-1.5, 1) == "\u22121.5");
  CHECK(fixed_signed(-0.001, 2) == "0.00");
}

TEST_CASE("escaped text cannot break out of its tag") {
  CHECK(escaped("<a href=\"x\">'&") == "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
  CHECK(escaped(std::string("a\x01\x1b") + "b") == "ab");
}

TEST_CASE("a long column keeps its ends, and the lowest and highest value of every span") {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 100'000; ++i) {
    x.push_back(i * 0.005);
    y.push_back(100.0 * std::sin(i * 0.7) + (i == 54'321 ? 500.0 : 0.0));
  }
  y[54'300] = NAN;  // a gap beside the peak
  const std::vector<std::size_t> rows = rows_to_keep(x, y);
  CHECK(rows.size() <= 6'004);
  CHECK(rows.front() == 0);
  CHECK(rows.back() == x.size() - 1);
  CHECK(std::is_sorted(rows.begin(), rows.end()));
  CHECK(std::count(rows.begin(), rows.end(), 54'321U) == 1);
  CHECK(rows_to_keep({}, {}).empty());
  CHECK(rows_to_keep({1.0, 2.0}, {NAN, 3.0}).size() == 2);
}

TEST_CASE("a curve's data are its values to eight digits, with null where a value is not finite") {
  CurveChart chart;
  chart.curves = {{"a </script>", {"--ink", 2.0, "8 3"}, {0.0, 1.0, 2.0}, {1.0 / 3.0, NAN, -INFINITY}}};
  chart.spans = {{0.5, 1.5, "flat"}};
  const json data = json::parse(chart_json(chart));
  const json& curve = data.at("curves").at(0);
  CHECK(std::abs(curve.at("y").at(0).get<double>() - 1.0 / 3.0) < 1e-8);
  CHECK(curve.at("y").at(1).is_null());
  CHECK(curve.at("y").at(2).is_null());
  CHECK(curve.at("dash") == json{8.0, 3.0});
  CHECK(data.at("spans").at(0).at("label") == "flat");
  CHECK(data.at("y_range").is_null());
  chart.y_range = {-1.0, 2.0};
  CHECK(json::parse(chart_json(chart)).at("y_range") == json{-1.0, 2.0});
}

TEST_CASE("charts of any values are JSON that no name in it can break out of") {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> awkward{
      {},         {NAN, NAN}, {0.0}, {5.0, 5.0, 5.0}, {-1e-300, 1e-300}, {-inf, 1.0, inf}, {-1e308, 1e308},
      {1, NAN, 3}};
  for (const std::vector<double>& values : awkward) {
    CurveChart lines;
    lines.curves = {{"a <b> \xff", {}, values, values}};
    CHECK(json::parse(chart_json(lines)).at("curves").size() == 1);
    const BoxChart boxes{
        "x", "%", 2, {{"a", "#000", summarize(values)}, {"b", "#000", summarize({1.0, 2.0, 3.0})}}};
    CHECK(json::parse(chart_json(boxes)).at("rows").size() == 2);
  }
  CurveChart named;
  named.y_label = "</script><b>";
  const std::string html = chart_figure(chart_json(named), "title <&>", "caption <&>");
  CHECK(is_well_formed(html));
  CHECK(html.find("<b>") == std::string::npos);
}

TEST_CASE("a box plot names median, quartiles and whiskers of each row, and rows without data") {
  const BoxChart chart{
      "x", "%", 2, {{"a", "#123456", summarize({1.0, 2.0, 3.0, 4.0, 5.0})}, {"b", "#000", {}}}};
  const json rows = json::parse(chart_json(chart)).at("rows");
  CHECK(rows.at(0).at("median") == 3.0);
  CHECK(rows.at(0).at("q25") == 2.0);
  CHECK(rows.at(0).at("q75") == 4.0);
  CHECK(rows.at(0).at("p05") == doctest::Approx(1.2));
  CHECK(rows.at(0).at("p95") == doctest::Approx(4.8));
  CHECK(rows.at(1).at("median").is_null());
}

TEST_CASE(
    "the box plot is logarithmic only when the values span a wide range, and its axis holds every box") {
  const auto axis = [](const std::vector<double>& a, const std::vector<double>& b) {
    return axis_of(BoxChart{"x", "%", 2, {{"a", "#000", summarize(a)}, {"b", "#000", summarize(b)}}});
  };
  const BoxAxis near = axis({1.0, 1.1, 1.2}, {2.0, 2.5, 3.0});
  CHECK_FALSE(near.is_logarithmic);
  CHECK(near.low == 0.0);
  CHECK(near.high > 2.95);
  const BoxAxis wide = axis({0.01, 0.011, 0.012}, {2.0, 2.5, 3.0});
  CHECK(wide.is_logarithmic);
  CHECK(wide.low > 0.0);
  CHECK(wide.low < 0.0105);
  CHECK(wide.high > 2.95);
}

}  // namespace isobar::test::test_charts
