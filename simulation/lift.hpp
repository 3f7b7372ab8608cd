// SPDX-License-Identifier: BSD-3-Clause
// An elevator with cabin and doors, and the motion of a robot that uses it.
#pragma once

#include <cstddef>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"
#include "simulation/world.hpp"

namespace isobar::simulation {

/// Sizes of a passenger elevator and of the opening in its shaft's wall.
struct LiftSizes {
  static constexpr double kCabinWidthM = 1.7;
  static constexpr double kCabinDepthM = 2.1;
  static constexpr double kDoorWidthM = 1.1;
  static constexpr double kDoorHeightM = 2.1;
  static constexpr double kShaftWallM = 0.25;  ///< thickness of the wall between corridor and shaft
};

/// Position of the elevator: the corridors of all storeys end at x = front_m, y = y_m, with the shaft behind.
struct LiftSite {
  double front_m = 0.0;
  double y_m = 0.0;
  std::vector<double> storeys_m;  ///< heights of the storeys' floors, ascending
};

/// Cuts the opening of the door and the shaft behind it out of the plan of a storey; `height_m`: of this part of the
/// shaft.
void cut_shaft(FloorPlan& plan, const LiftSite& site, double height_m);

/// Motion of robot and elevator on the common time grid.
class LiftDrive {
 public:
  /// `start`: of the robot; the cabin is on the lowest storey.
  LiftDrive(LiftSite site, Route start, Random& random);

  void drive(const std::vector<Waypoint>& way);
  void wait(double seconds);
  void turn_round();
  /// Starts in front of the door of one storey: waits for the cabin, drives in, turns round and rides to another storey,
  /// where the doors are open at the end. `from`, `to`: indices of LiftSite::storeys_m.
  void take_lift(std::size_t from, std::size_t to);

  [[nodiscard]] const Route& route() const { return route_; }
  /// Cabin and doors.
  [[nodiscard]] std::vector<MovingBody> bodies() const;

 private:
  void follow();
  void push(double cabin_z_m);
  void doors(std::size_t storey, double target);
  void move_cabin_to(double target_m);

  LiftSite site_;
  Route route_;
  Random& random_;
  std::vector<double> cabin_z_m_{0.0};
  std::vector<double> cabin_open_{0.0};           ///< doors per sample: 0 closed … 1 open
  std::vector<std::vector<double>> storey_open_;  ///< the same of each storey
  double cabin_door_ = 0.0;
  std::vector<double> storey_door_;
};

}  // namespace isobar::simulation
