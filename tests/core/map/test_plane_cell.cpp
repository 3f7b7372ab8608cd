// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "core/map/plane_cell.hpp"
#include "tests/core/map/point_moments.hpp"

namespace isobar::test::test_plane_cell {

namespace {

using isobar::fit_plane;
using isobar::Moments;
using isobar::Plane;
using isobar::PlaneCriteria;

constexpr float kNoiseM = 0.015F;

// Points of horizontal lidar rings on the wall y = 0 of a cell of 0.25 m, with range noise.
Moments wall_seen_by_rings(const std::vector<float>& ring_heights, std::mt19937& random) {
  std::normal_distribution<float> noise(0.0F, kNoiseM);
  Moments moments;
  for (const float z : ring_heights) {
    for (int i = 0; i < 40; ++i) {
      const float x = -0.12F + 0.006F * static_cast<float>(i);
      // The ray hits the wall obliquely: range noise shifts the point along the wall as well.
      const float range_error = noise(random);
      add_point(moments, {x + 0.6F * range_error, 0.8F * range_error, z});
    }
  }
  return moments;
}

}  // namespace

TEST_CASE("the points of three rings on a wall make a plane with the wall's normal") {
  std::mt19937 random(1);
  Plane plane;
  REQUIRE(fit_plane(wall_seen_by_rings({-0.1F, 0.0F, 0.1F}, random), PlaneCriteria{}, plane));
  // Standard deviation of the normal: noise / (half width * sqrt(points)), about 1 degree; tolerance: three
  // times that.
  CHECK(std::abs(plane.normal.y()) > std::cos(3.0F * 0.018F));
  CHECK(plane.thickness_m == doctest::Approx(0.8F * kNoiseM).epsilon(0.3));
}

TEST_CASE("a single ring makes no plane, however many points it has") {
  std::mt19937 random(2);
  const std::vector<float> one_ring_twenty_times(20, 0.03F);
  Plane plane;
  CHECK_FALSE(fit_plane(wall_seen_by_rings(one_ring_twenty_times, random), PlaneCriteria{}, plane));
}

TEST_CASE("a corner of two walls makes no plane") {
  Moments moments;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const float a = 0.02F * static_cast<float>(i);
      const float z = 0.02F * static_cast<float>(j);
      add_point(moments, {a, 0.0F, z});
      add_point(moments, {0.0F, a, z});
    }
  }
  Plane plane;
  CHECK_FALSE(fit_plane(moments, PlaneCriteria{}, plane));
}

TEST_CASE("thickness and normal agree with an eigensolver for every shape that counts as a plane") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  std::normal_distribution<float> normal;
  int planes = 0;
  for (int i = 0; i < 2000; ++i) {
    // Point clouds from lines to balls, in random attitude and off the centre.
    const Eigen::Matrix3f turn =
        Eigen::Quaternionf(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .toRotationMatrix();
    const Eigen::Vector3f size(0.12F, 0.12F * std::abs(uniform(random)), 0.06F * std::abs(uniform(random)));
    const Eigen::Vector3f centre = 0.1F * Eigen::Vector3f(uniform(random), uniform(random), uniform(random));
    Moments moments;
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 60; ++k) {
      const Eigen::Vector3f unit(uniform(random), uniform(random), uniform(random));
      const Eigen::Vector3f p = centre + turn * size.cwiseProduct(unit);
      add_point(moments, p);
      points.push_back(p.cast<double>());
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p / 60.0;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& p : points) covariance += (p - mean) * (p - mean).transpose() / 60.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
    const double thickness = std::sqrt(eigen.eigenvalues()(0));
    const double width = std::sqrt(eigen.eigenvalues()(1));
    const PlaneCriteria criteria;
    Plane plane;
    const bool is_plane = fit_plane(moments, criteria, plane);
    // Within one percent of a limit, rounding in single precision may decide either way.
    const double by_width = width / criteria.min_width_m;
    const double by_ratio = thickness * thickness / (0.15 * width * width);
    const double by_direction = thickness / (width * std::sqrt(60.0)) / criteria.max_normal_deviation_rad;
    if (by_width > 1.01 && by_ratio < 0.99 && by_direction < 0.99) CHECK(is_plane);
    if (by_width < 0.99 || by_ratio > 1.01 || by_direction > 1.01) CHECK_FALSE(is_plane);
    if (!is_plane) continue;
    ++planes;
    // Sums in single precision: the error of a variance is about 1e-9 m^2.
    CHECK(plane.thickness_m * plane.thickness_m ==
          doctest::Approx(thickness * thickness).epsilon(1e-3).scale(1e-5));
    CHECK(std::abs(plane.normal.cast<double>().dot(eigen.eigenvectors().col(0))) > 1.0 - 1e-5);
  }
  CHECK(planes > 300);
}

}  // namespace isobar::test::test_plane_cell
