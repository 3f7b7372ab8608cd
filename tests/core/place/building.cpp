// SPDX-License-Identifier: BSD-3-Clause
#include "tests/core/place/building.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "core/geometry.hpp"

namespace isobar::test {

namespace {

constexpr double kLidarM = 0.6;
constexpr double kSpacingM = 0.1;
constexpr double kNoiseM = 0.01;

/// Map whose planes are the faces themselves.
class FaceMap final : public MapSnapshot {
 public:
  explicit FaceMap(std::vector<Building::Face> faces)
      : MapSnapshot(0.25F, faces.size()), faces_(std::move(faces)) {}

  void match(const MatchQuery& query, std::span<const Eigen::Vector3f> p_local,
             std::span<PlaneMatch> matches) const override {
    const Eigen::Vector3d viewpoint = query.frame.to_map(query.viewpoint_local);
    for (std::size_t i = 0; i < p_local.size(); ++i) {
      const Eigen::Vector3d p = query.frame.to_map(p_local[i]);
      double nearest_m = static_cast<double>(query.max_distance_m);
      matches[i].found = false;
      for (const Building::Face& face : faces_) {
        const Eigen::Vector3d q = p.cwiseMax(face.low).cwiseMin(face.high);
        if ((q - p).norm() >= nearest_m || face.normal.dot(viewpoint - q) <= 0.0) continue;
        nearest_m = (q - p).norm();
        matches[i].found = matches[i].in_own_cell = true;
        matches[i].q_local = query.frame.to_local(q);
        matches[i].normal = face.normal.cast<float>();
      }
    }
  }

 private:
  std::vector<Building::Face> faces_;
};

}  // namespace

void Building::add_room(const Eigen::Vector3d& low, const Eigen::Vector3d& high, unsigned open_faces) {
  world_.add_box(low, high, open_faces);
  add_faces(low, high, open_faces, 1.0);
}

void Building::add_obstacle(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  world_.add_box(low, high);
  add_faces(low, high, 0, -1.0);
}

void Building::add_faces(const Eigen::Vector3d& low, const Eigen::Vector3d& high, unsigned open_faces,
                         double sign) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      if ((open_faces >> static_cast<unsigned>(2 * axis + side) & 1U) != 0) continue;
      Face face{axis, low, high, Eigen::Vector3d::Zero()};
      (side == 0 ? face.high : face.low)[axis] = side == 0 ? low[axis] : high[axis];
      face.normal[axis] = side == 0 ? sign : -sign;
      faces_.push_back(face);
    }
  }
}

std::vector<MapPoint> Building::points() const {
  std::vector<MapPoint> points;
  for (const Face& face : faces_) {
    const int u = (face.axis + 1) % 3;
    const int v = (face.axis + 2) % 3;
    for (double a = face.low[u] + 0.5 * kSpacingM; a < face.high[u]; a += kSpacingM) {
      for (double b = face.low[v] + 0.5 * kSpacingM; b < face.high[v]; b += kSpacingM) {
        MapPoint point;
        point.p_map[face.axis] = face.low[face.axis];
        point.p_map[u] = a;
        point.p_map[v] = b;
        point.normal_map = face.normal.cast<float>();
        points.push_back(point);
      }
    }
  }
  return points;
}

KnownMap Building::map() const { return {points(), std::make_shared<const FaceMap>(faces_)}; }

std::vector<Eigen::Vector3f> Building::seen_from(const Eigen::Isometry3d& T_map_level) const {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, kNoiseM);
  const Eigen::Vector3d p_level_lidar(0.0, 0.0, kLidarM);
  std::vector<Eigen::Vector3f> points;
  for (int column = 0; column < 360; ++column) {
    for (int ring = 0; ring < 16; ++ring) {
      const double azimuth = column * kRadPerDeg;
      const double elevation = (2.0 * ring - 15.0) * kRadPerDeg;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range_m = world_.range(T_map_level * p_level_lidar, T_map_level.linear() * ray);
      if (range_m < 60.0)
        points.emplace_back((p_level_lidar + (range_m + noise(random)) * ray).cast<float>());
    }
  }
  return points;
}

void Building::look(const Eigen::Isometry3d& T_map_level, PlaceQuery& query) const {
  query.clear();
  query.add(seen_from(T_map_level), Eigen::Vector3f(0.0F, 0.0F, static_cast<float>(kLidarM)));
  query.finish();
}

Eigen::Isometry3d level_pose_at(double x_m, double y_m, double z_m, double yaw_deg) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() << x_m, y_m, z_m;
  return T;
}

Building office() {
  Building building;
  building.add_room({-5.0, -4.0, 0.0}, {5.0, 4.0, 3.0});
  building.add_obstacle({2.0, 2.0, 0.0}, {3.0, 3.2, 1.8});
  building.add_obstacle({-4.2, -3.0, 0.0}, {-3.0, -1.8, 1.2});
  building.add_obstacle({3.5, -2.5, 0.0}, {4.0, -1.5, 2.2});
  building.add_room({8.0, -3.0, 0.0}, {20.0, 3.0, 3.0});
  building.add_obstacle({10.0, -3.0, 0.0}, {11.5, -1.0, 2.0});
  building.add_obstacle({13.0, 1.6, 0.0}, {13.6, 2.6, 2.4});
  return building;
}

}  // namespace isobar::test
