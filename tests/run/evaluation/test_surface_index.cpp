// SPDX-License-Identifier: BSD-3-Clause
#include "run/evaluation/surface_index.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>

#include "core/errors.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/files/ply_writer.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "tests/run/evaluation/paths.hpp"
#include "tests/run/evaluation/runs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_surface_index {

using namespace isobar::evaluation;
using namespace isobar::test;
using Eigen::Vector3f;
using files::SurfaceTriangle;

namespace {

/// A level rectangle at a height.
std::vector<SurfaceTriangle> floor_at(float x0, float y0, float x1, float y1, float z) {
  const Vector3f a(x0, y0, z);
  const Vector3f b(x1, y0, z);
  const Vector3f c(x1, y1, z);
  const Vector3f d(x0, y1, z);
  return {{a, b, c}, {a, c, d}};
}

}  // namespace

TEST_CASE("the distance from a triangle is that of its face, edge or corner, whichever is nearest") {
  const SurfaceIndex index({{Vector3f(0, 0, 0), Vector3f(10, 0, 0), Vector3f(0, 10, 0)}});
  CHECK(index.distance_m({2.0F, 3.0F, 0.1F}) == doctest::Approx(0.1));                   // face
  CHECK(index.distance_m({2.0F, 3.0F, -0.1F}) == doctest::Approx(0.1));                  // its other side
  CHECK(index.distance_m({5.0F, -0.06F, 0.08F}) == doctest::Approx(0.1));                // edge along x
  CHECK(index.distance_m({-0.03F, 5.0F, 0.04F}) == doctest::Approx(0.05));               // edge along y
  CHECK(index.distance_m({5.1F, 5.1F, 0.0F}) == doctest::Approx(0.2 / std::sqrt(2.0)));  // oblique edge
  CHECK(index.distance_m({-0.06F, -0.08F, 0.0F}) == doctest::Approx(0.1));               // corners
  CHECK(index.distance_m({10.1F, -0.05F, 0.0F}) == doctest::Approx(std::hypot(0.1, 0.05)));
  CHECK(index.distance_m({-0.05F, 10.1F, 0.0F}) == doctest::Approx(std::hypot(0.1, 0.05)));
  CHECK(index.distance_m({2.0F, 3.0F, 0.5F}) == SurfaceIndex::kReachM);
  CHECK(index.distance_m({-500.0F, 3.0F, 0.5F}) == SurfaceIndex::kReachM);
}

TEST_CASE("shares of points within 5 cm and beyond 20 cm; the nearest of several surfaces counts") {
  std::vector<SurfaceTriangle> surfaces = floor_at(-20, -20, 20, 20, 0);
  for (const SurfaceTriangle& triangle : floor_at(-20, -20, 20, 20, 3)) surfaces.push_back(triangle);
  const SurfaceIndex index(surfaces);
  const MapFigures figures =
      map_figures({{1, 1, 0.04F}, {-19, 3, 2.97F}, {5, 5, 0.1F}, {5, 5, 1.5F}, {30, 0, 0}}, index);
  CHECK(figures.within_5_cm == doctest::Approx(0.4));
  CHECK(figures.beyond_20_cm == doctest::Approx(0.4));
  CHECK(std::isnan(map_figures({}, index).within_5_cm));
}

TEST_CASE("surfaces come back from an STL file; a cut, a foreign and a damaged one are errors") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "surfaces.stl";
  const std::vector<SurfaceTriangle> surfaces = floor_at(-1.5F, 2.25F, 3.0F, 4.0F, -7.125F);
  files::write_stl(file, surfaces);
  CHECK((files::read_stl(file) == surfaces));
  const std::string bytes = files::read_text_file(file);
  CHECK(bytes.size() == 84 + 2 * 50);
  files::write_text_file(file, bytes.substr(0, bytes.size() - 1));
  CHECK_THROWS_AS(files::read_stl(file), DataError);
  files::write_text_file(file, "solid room");
  CHECK_THROWS_AS(files::read_stl(file), DataError);
  std::vector<SurfaceTriangle> damaged = surfaces;
  damaged[1][2].y() = std::numeric_limits<float>::infinity();
  files::write_stl(file, damaged);
  CHECK_THROWS_AS(files::read_stl(file), DataError);
}

TEST_CASE("the map of a run is compared with the surfaces of its recording, in the reference's frame") {
  const TemporaryFolder folder;
  const std::filesystem::path recording = write_recording(folder.path() / "recording");
  write_run(folder.path() / "run", 0.0);  // map points on the x axis of the reference
  files::write_stl(recording / files::kSurfacesFile, floor_at(-10, -1, 30, 1, 0));
  const EvaluatedRun run = evaluate_methods(load_reference(recording), {{"run", folder.path() / "run"}});
  // 2000 points every 3 cm from x = 0 to 60 m, on surfaces up to 30 m.
  CHECK(run.methods.front().evaluation.figures.map.within_5_cm == doctest::Approx(0.5).epsilon(0.01));
  CHECK(run.methods.front().evaluation.figures.map.beyond_20_cm == doctest::Approx(0.5).epsilon(0.02));
  std::filesystem::remove(recording / files::kSurfacesFile);
  const EvaluatedRun none = evaluate_methods(load_reference(recording), {{"run", folder.path() / "run"}});
  CHECK(std::isnan(none.methods.front().evaluation.figures.map.within_5_cm));
}

}  // namespace isobar::test::test_surface_index
