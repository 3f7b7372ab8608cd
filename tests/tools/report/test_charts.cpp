// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/tools/report/well_formed.hpp"
#include "tools/report/box_plot.hpp"
#include "tools/report/histogram.hpp"
#include "tools/report/line_chart.hpp"

namespace isobar::test::test_charts {

using namespace isobar::report;
using isobar::summarize;
using isobar::test::is_well_formed;

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

TEST_CASE("ticks are round numbers inside the range, as many as fit") {
  for (const Range range : {Range{0.0, 1.0}, Range{-3.7, 12.2}, Range{0.001, 0.0042}, Range{1e6, 1.0003e6}}) {
    const Scale scale = Scale::linear(range, 0.0, 900.0, 90.0);
    REQUIRE(scale.ticks().size() >= 4);
    CHECK(scale.ticks().size() <= 11);
    const double step = scale.ticks()[1].value - scale.ticks()[0].value;
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    CHECK((std::abs(mantissa - 1) < 1e-3 || std::abs(mantissa - 2) < 1e-3 || std::abs(mantissa - 5) < 1e-3));
    for (const Tick& tick : scale.ticks()) {
      CHECK(tick.value >= range.low - 1e-6 * step);
      CHECK(tick.value <= range.high + 1e-6 * step);
    }
  }
  CHECK(Scale::linear({0.0, 0.5}, 0, 900, 90).ticks()[1].label == "0.05");
  CHECK(Scale::linear({-5.0, 0.0}, 0, 900, 200).ticks()[0].label == "\u22124");
}

TEST_CASE("a scale maps its range onto its pixels, linearly or logarithmically") {
  const Scale linear = Scale::linear({10.0, 20.0}, 400.0, 100.0, 90.0);
  CHECK(linear(10.0) == doctest::Approx(400.0));
  CHECK(linear(15.0) == doctest::Approx(250.0));
  CHECK(linear.clamped(99.0) == doctest::Approx(100.0));
  const Scale logarithmic = Scale::logarithmic({0.1, 10.0}, 0.0, 200.0);
  CHECK(logarithmic(1.0) == doctest::Approx(100.0));
  CHECK(logarithmic.ticks().size() == 7);  // 0.1 0.2 0.5 1 2 5 10
}

TEST_CASE("thinning keeps the ends, and the lowest and highest point of every pixel column") {
  std::vector<Point> points;
  for (int i = 0; i < 100'000; ++i)
    points.push_back({i * 0.005, 100.0 * std::sin(i * 0.7) + (i == 54'321 ? 500.0 : 0.0)});
  const std::vector<Point> kept = thinned(points);
  CHECK(kept.size() <= 4 * 501);
  CHECK(kept.front().x == points.front().x);
  CHECK(kept.back().x == points.back().x);
  double highest = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    highest = std::max(highest, kept[i].y);
    if (i > 0) CHECK(kept[i].x >= kept[i - 1].x);
  }
  CHECK(highest > 400.0);
  CHECK(thinned({}).empty());
}

TEST_CASE("simplifying keeps corners, and removes only points within the tolerance of the remaining line") {
  std::vector<Point> corner;
  for (int i = 0; i <= 100; ++i) corner.push_back({0.1 * i, 0.0});
  for (int i = 1; i <= 100; ++i) corner.push_back({10.0, 0.1 * i});
  REQUIRE(simplified(corner, 0.05).size() == 3);
  CHECK(simplified(corner, 0.05)[1].x == doctest::Approx(10.0));
  std::vector<Point> wave;
  for (int i = 0; i <= 1000; ++i) wave.push_back({0.5 * i, 40.0 * std::sin(0.02 * i)});
  const std::vector<Point> kept = simplified(wave, 0.2);
  CHECK(kept.size() < 150);
  std::size_t after = 1;
  for (const Point& p : wave) {
    while (kept[after].x < p.x) ++after;
    const Point& a = kept[after - 1];
    const Point& b = kept[after];
    const double y = a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x);
    // With slopes up to 1.6, the vertical distance is less than twice the perpendicular one.
    CHECK(std::abs(p.y - y) < 0.2 * 2.0);
  }
}

TEST_CASE("charts stay well-formed with any values") {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> awkward{{},
                                                 {NAN, NAN},
                                                 {0.0},
                                                 {5.0, 5.0, 5.0},
                                                 {-1e-300, 1e-300},
                                                 {-inf, 1.0, inf},
                                                 {1e17, 1e17 + 16},
                                                 {-1e308, 1e308},
                                                 {1, NAN, 3}};
  for (const std::vector<double>& values : awkward) {
    LineChart lines;
    lines.series = {{"a <b>", {}, values, values}};
    lines.bands = {{0.0, 1.0, "flat & even"}};
    lines.id = "lines";
    CHECK(is_well_formed(draw(lines).svg("title <&>")));
    CHECK(is_well_formed(draw(HistogramChart{"x", "ms", {{"a", "#000", values}}}).svg("t")));
    BoxPlot boxes{"x", "%", 2, {{"a", "#000", summarize(values)}, {"b", "#000", summarize({1.0, 2.0, 3.0})}}};
    CHECK(is_well_formed(draw(boxes).svg("t")));
  }
}

TEST_CASE("the box plot is logarithmic only when the values span a wide range") {
  const auto has_tick = [](const std::vector<double>& a, const std::vector<double>& b,
                           const std::string& label) {
    const BoxPlot plot{"x", "%", 2, {{"a", "#000", summarize(a)}, {"b", "#000", summarize(b)}}};
    return draw(plot).svg("t").find(">" + label + "</text>") != std::string::npos;
  };
  CHECK(has_tick({1.0, 1.1, 1.2}, {2.0, 2.5, 3.0}, "0.0"));             // from zero
  CHECK_FALSE(has_tick({0.01, 0.011, 0.012}, {2.0, 2.5, 3.0}, "0.0"));  // ratios
  CHECK(has_tick({0.01, 0.011, 0.012}, {2.0, 2.5, 3.0}, "0.1"));
}

TEST_CASE("a chart with logarithmic axes spaces decades evenly") {
  LineChart chart;
  chart.is_logarithmic = true;
  chart.id = "log";
  chart.series.push_back({"1/x", {}, {0.1, 1.0, 10.0, 100.0}, {10.0, 1.0, 0.1, 0.01}});
  const std::string svg = draw(chart).svg("a power law");
  CHECK(is_well_formed(svg));
  // A power law is a straight line here: only its ends remain.
  const std::size_t points = svg.find("points=\"");
  REQUIRE(points != std::string::npos);
  const std::string line = svg.substr(points + 8, svg.find('"', points + 8) - points - 8);
  CHECK(std::count(line.begin(), line.end(), ',') == 2);
}

}  // namespace isobar::test::test_charts
