// SPDX-License-Identifier: BSD-3-Clause
// An elevator with cabin and doors, and the motion of a robot that uses it.
#pragma once

#include <vector>

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

/// Position of the elevator: the corridors of both storeys end at x = front_m, y = 0, with the shaft behind.
struct LiftSite {
  double front_m = 0.0;
  double height_m = 0.0;  ///< height of the upper storey; the lower one is at 0
};

/// Motion of robot and elevator on the common time grid.
class LiftDrive {
 public:
  /// The robot starts at x = start_m on the upper storey, facing the elevator; the cabin is on the lower
  /// storey.
  LiftDrive(const LiftSite& site, double start_m, Random& random);

  void drive(const std::vector<Waypoint>& way);
  void wait(double seconds);
  void turn_round();
  /// Starts in front of the door: waits for the cabin, drives in, turns round and rides to the other storey,
  /// where the doors are open at the end.
  void take_lift();

  [[nodiscard]] const Route& route() const { return route_; }
  /// Cabin and doors.
  [[nodiscard]] std::vector<MovingBody> bodies() const;

 private:
  void follow();
  void push(double cabin_z_m);
  void doors(bool top, double target);
  void move_cabin_to(double target_m);

  LiftSite site_;
  Route route_;
  Random& random_;
  std::vector<double> cabin_z_m_{0.0};
  std::vector<double> cabin_open_{0.0};  ///< doors per sample: 0 closed … 1 open
  std::vector<double> top_open_{0.0};
  std::vector<double> ground_open_{0.0};
  double cabin_door_ = 0.0;
  double top_door_ = 0.0;
  double ground_door_ = 0.0;
};

}  // namespace isobar::simulation
