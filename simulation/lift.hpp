// SPDX-License-Identifier: BSD-3-Clause
// An elevator: cabin, doors, and a robot that is carried by it.
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
  static constexpr double kShaftWallM = 0.25;  ///< between corridor and shaft
};

/// The corridors of both storeys end at x = front_m, y = 0; the shaft lies beyond.
struct LiftSite {
  double front_m = 0.0;
  double height_m = 0.0;  ///< of the upper storey above the lower one's 0
};

/// Drives the robot and the lift together, on one time grid.
class LiftDrive {
 public:
  /// The robot stands at x = start_m on the upper storey and faces the lift, whose cabin waits below.
  LiftDrive(const LiftSite& site, double start_m, Random& random);

  void drive(const std::vector<Waypoint>& way);
  void wait(double seconds);
  void turn_round();
  /// From before the door: waits for the cabin, drives in, turns round, is carried to the other storey; the
  /// doors are open at the end.
  void take_lift();

  [[nodiscard]] const Route& route() const { return route_; }
  /// Cabin and doors as the lidar sees them.
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
  std::vector<double> cabin_open_{0.0};  ///< doors: 0 shut … 1 open
  std::vector<double> top_open_{0.0};
  std::vector<double> ground_open_{0.0};
  double cabin_door_ = 0.0;
  double top_door_ = 0.0;
  double ground_door_ = 0.0;
};

}  // namespace isobar::simulation
