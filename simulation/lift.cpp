// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace isobar::simulation {

namespace {

constexpr double kDoorTimeS = 2.5;  // time that a door takes to open or close
constexpr double kSillM = 0.12;     // from the shaft's wall to the inside of the cabin
// Typical of passenger elevators: 1 m/s, up to 1 m/s^2.
constexpr double kLiftSpeedMS = 1.0;
constexpr double kLiftAccelerationMS2 = 0.8;

/// Inner walls, floor and ceiling of the cabin; it extends along +x and is open at x = 0.
Mesh make_cabin() {
  Mesh mesh;
  const double half = 0.5 * LiftSizes::kCabinWidthM;
  const double top = 2.25;
  const double door = 0.5 * LiftSizes::kDoorWidthM;
  const double x0 = kSillM;
  const double x1 = x0 + LiftSizes::kCabinDepthM;
  const Surface metal = Surface::kMetal;
  mesh.quad({0.0, -half, 0.0}, {x1, -half, 0.0}, {x1, half, 0.0}, {0.0, half, 0.0}, Surface::kConcrete);
  mesh.quad({x0, -half, top}, {x1, -half, top}, {x1, half, top}, {x0, half, top}, Surface::kPlaster);
  mesh.quad({x1, -half, 0.0}, {x1, half, 0.0}, {x1, half, top}, {x1, -half, top}, metal);
  for (const double side : {-1.0, 1.0}) {
    mesh.quad({x0, side * half, 0.0}, {x1, side * half, 0.0}, {x1, side * half, top}, {x0, side * half, top},
              metal);
    mesh.quad({x0, side * door, 0.0}, {x0, side * half, 0.0}, {x0, side * half, top}, {x0, side * door, top},
              metal);
    // handrails
    mesh.box({x0 + 0.2, side * half, 0.85}, {x1 - 0.2, side * (half - 0.06), 0.92}, metal);
  }
  mesh.quad({x0, -door, LiftSizes::kDoorHeightM}, {x0, door, LiftSizes::kDoorHeightM}, {x0, door, top},
            {x0, -door, top}, metal);
  return mesh;
}

/// One leaf of a sliding door, `side` -1 or +1. At its origin it is closed and overlaps the other leaf by 2
/// cm.
Mesh make_leaf(double side) {
  Mesh mesh;
  mesh.box({-0.02, std::min(-side * 0.01, side * 0.5 * LiftSizes::kDoorWidthM), 0.0},
           {0.02, std::max(-side * 0.01, side * 0.5 * LiftSizes::kDoorWidthM), LiftSizes::kDoorHeightM},
           Surface::kMetal);
  return mesh;
}

/// Both leaves of a door at (x, y) that slides along y. `open`: 0 closed … 1 open, per sample.
void add_doors(std::vector<MovingBody>& bodies, double x, double y, const std::vector<double>& open,
               const std::vector<double>& z) {
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> slide;
    slide.reserve(open.size());
    for (const double fraction : open) slide.push_back(y + side * fraction * 0.5 * LiftSizes::kDoorWidthM);
    bodies.push_back({RayCaster(make_leaf(side)), Channel(std::vector<double>(open.size(), x)),
                      Channel(std::move(slide)), Channel(z)});
  }
}

}  // namespace

void cut_shaft(FloorPlan& plan, const LiftSite& site, double height_m) {
  const double half = 0.5 * LiftSizes::kDoorWidthM;
  const double x = site.front_m;
  const double y = site.y_m;
  plan.cut({{x, y - half, x + LiftSizes::kShaftWallM, y + half}, 0.0, LiftSizes::kDoorHeightM});
  plan.cut({{x + LiftSizes::kShaftWallM, y - 1.0, x + LiftSizes::kShaftWallM + 2.5, y + 1.0},
            0.0,
            height_m,
            false,
            false});
}

LiftDrive::LiftDrive(LiftSite site, Route start, Random& random)
    : site_(std::move(site)),
      route_(std::move(start)),
      random_(random),
      storey_open_(site_.storeys_m.size(), std::vector<double>{0.0}),
      storey_door_(site_.storeys_m.size(), 0.0) {}

void LiftDrive::drive(const std::vector<Waypoint>& way) {
  route_.drive(way);
  follow();
}

void LiftDrive::wait(double seconds) {
  route_.wait(seconds);
  follow();
}

void LiftDrive::turn_round() {
  route_.turn(random_.sign() * std::numbers::pi);
  follow();
}

void LiftDrive::take_lift(std::size_t from, std::size_t to) {
  move_cabin_to(site_.storeys_m[from]);
  doors(from, 1.0);
  const double middle_m = site_.front_m + LiftSizes::kShaftWallM + kSillM + 0.5 * LiftSizes::kCabinDepthM;
  drive({{{middle_m, site_.y_m}, route_.pose().z_m, 0.4, "flat"}});
  turn_round();
  doors(from, 0.0);
  const double before_m = route_.pose().z_m;
  const double cabin_m = cabin_z_m_.back();
  const std::size_t first = route_.samples().size();
  route_.ride(site_.storeys_m[to] - site_.storeys_m[from], kLiftSpeedMS, kLiftAccelerationMS2);
  for (std::size_t i = first; i < route_.samples().size(); ++i) {
    push(cabin_m + route_.samples()[i].z_m - before_m);
  }
  doors(to, 1.0);
}

/// Pads the elevator's samples to the length of the robot's: the elevator stands still while the robot
/// drives.
void LiftDrive::follow() {
  while (cabin_z_m_.size() < route_.samples().size()) push(cabin_z_m_.back());
}

void LiftDrive::push(double cabin_z_m) {
  cabin_z_m_.push_back(cabin_z_m);
  cabin_open_.push_back(cabin_door_);
  for (std::size_t i = 0; i < storey_open_.size(); ++i) storey_open_[i].push_back(storey_door_[i]);
}

/// Opens (1) or closes (0) the doors of the cabin and of one storey while the robot waits.
void LiftDrive::doors(std::size_t storey, double target) {
  const double from = cabin_door_;
  for (double t = SplineGrid::kStepS; t <= kDoorTimeS; t += SplineGrid::kStepS) {
    const double phase = t / kDoorTimeS;
    cabin_door_ = from + (target - from) * 0.5 * (1.0 - std::cos(std::numbers::pi * phase));
    storey_door_[storey] = cabin_door_;
    wait(2.0 * SplineGrid::kStepS);
  }
  wait(random_.uniform(0.8, 1.5));
}

/// Moves the empty cabin to another storey behind closed doors while the robot waits.
void LiftDrive::move_cabin_to(double target_m) {
  const double from_m = cabin_z_m_.back();
  const double seconds = std::abs(target_m - from_m) / kLiftSpeedMS;
  const auto steps = static_cast<int>(seconds / SplineGrid::kStepS);
  if (steps == 0) return;
  route_.wait(seconds + SplineGrid::kStepS);
  for (int i = 1; cabin_z_m_.size() < route_.samples().size(); ++i) {
    push(from_m + (target_m - from_m) * std::min(1.0, static_cast<double>(i) / steps));
  }
}

std::vector<MovingBody> LiftDrive::bodies() const {
  std::vector<MovingBody> bodies;
  const std::size_t samples = cabin_z_m_.size();
  const double x = site_.front_m + LiftSizes::kShaftWallM;
  bodies.push_back({RayCaster(make_cabin()), Channel(std::vector<double>(samples, x)),
                    Channel(std::vector<double>(samples, site_.y_m)), Channel(cabin_z_m_)});
  const double landing_x = site_.front_m + 0.15;
  add_doors(bodies, x + 0.08, site_.y_m, cabin_open_, cabin_z_m_);
  for (std::size_t i = storey_open_.size(); i-- > 0;) {
    add_doors(bodies, landing_x, site_.y_m, storey_open_[i],
              std::vector<double>(samples, site_.storeys_m[i]));
  }
  return bodies;
}

}  // namespace isobar::simulation
