// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>

#include "core/errors.hpp"
#include "tests/run/evaluation/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/tools/report/well_formed.hpp"
#include "tools/report/report.hpp"

namespace isobar::test::test_report {

using namespace isobar::report;
using evaluation::Trajectory;
using isobar::test::at_ns;
using isobar::test::is_well_formed;
using isobar::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

std::string tum_text(const Trajectory& trajectory) {
  std::string text;
  for (const evaluation::StampedPose& p : trajectory.poses) {
    std::array<char, 300> line{};
    std::snprintf(line.data(), line.size(), "%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                  static_cast<long long>(p.stamp_ns / 1'000'000'000),
                  static_cast<long long>(p.stamp_ns % 1'000'000'000), p.position_m.x(), p.position_m.y(),
                  p.position_m.z(), p.attitude.x(), p.attitude.y(), p.attitude.z(), p.attitude.w());
    text += line.data();
  }
  return text;
}

/// A replay whose height drifts by `slope`, with status and map, moved out of the reference's frame by (7, 8,
/// 9) m.
void write_replay(const fs::path& folder, double slope) {
  files::ReplayOutputWriter writer(folder);
  for (const evaluation::StampedPose& p : isobar::test::straight(60.0, 0.1, slope).poses) {
    PoseEstimate pose;
    pose.stamp_ns = p.stamp_ns;
    pose.T_map_base.translation() = p.position_m - Eigen::Vector3d(7, 8, 9);
    pose.covariance(2, 2) = 0.01;
    pose.registration_ms = 20.0 + std::fmod(p.position_m.x(), 3.0);
    writer.add(pose, -9.0, 0.05);
  }
  writer.close();
  files::PlyWriter map(writer.map_file());
  for (int i = 0; i < 2000; ++i) map.add(0.03F * static_cast<float>(i) - 7.0F, -8.0F, -9.0F, 1.0F);
  map.close();
}

fs::path write_recording(const fs::path& folder) {
  fs::create_directories(folder);
  files::write_text_file(folder / "reference.tum", tum_text(isobar::test::straight(60.0, 0.02)));
  files::write_text_file(folder / "segments.csv", "t_start_ns,t_end_ns,label\n" + std::to_string(at_ns(0)) +
                                                      "," + std::to_string(at_ns(60)) + ",flat\n");
  return folder;
}

EvaluatedRun two_methods(const fs::path& folder) {
  write_replay(folder / "3dof", 0.001);
  write_replay(folder / "4dof", 0.05);
  return evaluate_methods(load_reference(write_recording(folder / "recording")),
                          {{"", folder / "3dof"}, {"", folder / "4dof"}});
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("two replays of a recording are evaluated with its segments, sigma, map and status") {
  const TemporaryFolder folder;
  const EvaluatedRun run = two_methods(folder.path());
  REQUIRE(run.methods.size() == 2);
  CHECK(run.methods[0].name == "3dof");
  CHECK(run.methods[1].evaluation.figures.z_rpe.median ==
        doctest::Approx(0.05).epsilon(1e-3));                                    // six decimals
  CHECK(run.methods[0].evaluation.figures.sigma_share == doctest::Approx(1.0));  // 6 cm against 2 * 10 cm
  CHECK(run.methods[1].evaluation.figures.sigma_share < 0.1);
  CHECK_FALSE(run.methods[0].evaluation.figures.whole_run_as_flat);
  REQUIRE(run.methods[0].map_points.size() == 2000);
  CHECK(run.methods[0].map_points[0][0] ==
        doctest::Approx(0.0).epsilon(1e-4));  // moved into the reference's frame
  CHECK(run.methods[0].map_points[0][2] == doctest::Approx(0.0).epsilon(1e-4));
  CHECK(run.notes.empty());
}

TEST_CASE("the report is one well-formed file that loads nothing, with every section") {
  const TemporaryFolder folder;
  const ReportInput input{"Title <&>", "What \"it\" is", "isobar evaluate a b", two_methods(folder.path())};
  const std::string html = render_report(input);
  std::string body = html.substr(html.find("<body>"));
  body.erase(body.find("</html>"));
  CHECK(is_well_formed(body));
  CHECK(contains(html, "<h1>Title &lt;&amp;&gt;</h1>"));
  CHECK(contains(html, "isobar evaluate a b"));
  CHECK_FALSE(contains(html, "<script"));
  CHECK_FALSE(contains(html, "src="));
  CHECK_FALSE(contains(html, "@import"));
  CHECK_FALSE(contains(html, "href=\"http"));
  for (const char* section : {"Relative error on z", "Height along the way", "Height error along the way",
                              "The map from the side", "The map from above", "Time per scan", "All figures",
                              "Height of each floor", "How these figures are made", "Altimeter"}) {
    CHECK_MESSAGE(contains(html, section), section);
  }
  CHECK(is_well_formed(render_overview_svg(input)));
}

TEST_CASE(
    "bare trajectories without segments, status and map make a report too, which says what is missing") {
  const TemporaryFolder folder;
  const fs::path reference = folder.path() / "r.tum";
  files::write_text_file(reference, tum_text(isobar::test::straight(30.0, 0.1)));
  SUBCASE("a whole run") {
    files::write_text_file(folder.path() / "e.tum", tum_text(isobar::test::straight(30.0, 0.1)));
  }
  SUBCASE("a single pose") {
    files::write_text_file(folder.path() / "e.tum", tum_text(isobar::test::straight(0.0, 0.1)));
  }
  const ReportInput input{"t", "", "",
                          evaluate_methods(load_reference(reference), {{"", folder.path() / "e.tum"}})};
  CHECK(contains(input.run.notes.at(0), "No flat segments"));
  const std::string html = render_report(input);
  CHECK(contains(html, "No flat segments"));
  CHECK_FALSE(contains(html, "Time per scan"));
  CHECK_FALSE(contains(html, "The map from the side"));
  std::string body = html.substr(html.find("<body>"));
  body.erase(body.find("</html>"));
  CHECK(is_well_formed(body));
}

TEST_CASE("a reference at rest in one place makes no division by its distance") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "r.tum";
  files::write_text_file(file, "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  const ReportInput input{"t", "", "", evaluate_methods(load_reference(file), {{"same", file}})};
  CHECK(std::isnan(input.run.methods[0].evaluation.figures.ate_share));
  CHECK(contains(figures_json(input.run), "\"ate_share_of_distance\": null"));
  CHECK(contains(render_report(input), "All figures"));
}

TEST_CASE("names come from folders and files, and from the path where two are the same") {
  std::vector<EstimateSource> sources{{"", "runs/3dof"}, {"", "runs/4dof/"}, {"", "x/trajectory.tum"},
                                      {"", "a/run.tum"}, {"", "b/run.tum"},  {"mine", "c"}};
  default_names(sources);
  CHECK(sources[0].name == "3dof");
  CHECK(sources[1].name == "4dof");
  CHECK(sources[2].name == "x");
  CHECK(sources[3].name == "a/run.tum");
  CHECK(sources[4].name == "b/run.tum");
  CHECK(sources[5].name == "mine");
}

TEST_CASE("an estimate of another time is refused with its name") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / "r.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  files::write_text_file(folder.path() / "e.tum", "91 0 0 0 0 0 0 1\n");
  try {
    evaluate_methods(load_reference(folder.path() / "r.tum"), {{"", folder.path() / "e.tum"}});
    FAIL("was accepted");
  } catch (const DataError& error) {
    CHECK(contains(error.what(), "e.tum: no pose lies within the time of the reference"));
  }
}

}  // namespace isobar::test::test_report
