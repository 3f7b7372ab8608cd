// SPDX-License-Identifier: BSD-3-Clause
// Staircase of two flights with a half landing, in a stairwell.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"

namespace isobar::simulation {

/// Dimensions of the stairs. Usual stairs have 2 * rise + going = 0.63 m.
struct StairSizes {
  int steps = 17;  ///< per flight
  double rise_m = 0.17;
  double going_m = 0.29;
  [[nodiscard]] double flight_m() const { return steps * rise_m; }
  [[nodiscard]] double storey_m() const { return 2.0 * flight_m(); }
  static StairSizes draw(Random& random, int steps_low, int steps_high);
};

/// Own coordinates [m]: u away from the corridor's end, v towards the side of the upper flight. The lower
/// flight ascends along +u at v = 0, the upper one along -u at v = kLaneGapM.
class Stairwell {
 public:
  /// `entrance_m`: centre of the corridor's end; `away`: unit vector of u, along a world axis; `side`: +1:
  /// upper flight to the left of `away`, -1: to the right.
  Stairwell(const Eigen::Vector2d& entrance_m, const Eigen::Vector2d& away, double side,
            const StairSizes& sizes);

  [[nodiscard]] Rect rect() const;
  [[nodiscard]] const StairSizes& sizes() const { return sizes_; }
  /// Cuts the stairwell out of the plan of the lower storey.
  void cut_lower(FloorPlan& plan) const;
  /// Cuts the stairwell out of the plan of the upper storey, whose ceiling is at `ceiling_m`.
  void cut_upper(FloorPlan& plan, double ceiling_m) const;
  /// Cuts the stairwell out of the plan of a storey from which stairs lead up and down.
  void cut_middle(FloorPlan& plan) const;
  /// Adds steps, landings and parapets. `z_m`: floor of the lower storey; `goes_on`: more stairs lead up from
  /// the upper storey, so that no balustrade closes its landing.
  void build(Mesh& mesh, double z_m, bool goes_on = false) const;
  /// Appends the way from the corridor's end on the lower storey to that on the upper one. `z_m`: as in
  /// build().
  void route_up(std::vector<Waypoint>& way, double z_m, double speed_m_s) const;
  /// Appends the reverse way. `z_m`: as in build().
  void route_down(std::vector<Waypoint>& way, double z_m, double speed_m_s) const;

 private:
  static constexpr double kLaneGapM = 1.5;      // between the centre lines of the two flights
  static constexpr double kHalfLaneM = 0.68;    // half of the width of a flight
  static constexpr double kLandingM = 2.5;      // depth of the landings on the storeys
  static constexpr double kHalfLandingM = 2.0;  // depth of the landing between the flights

  [[nodiscard]] Eigen::Vector2d plan(double u, double v) const;
  [[nodiscard]] Eigen::Vector3d point(double u, double v, double z) const;
  [[nodiscard]] double run_m() const { return (sizes_.steps - 1) * sizes_.going_m; }
  void add_flight(Mesh& mesh, double start_u, double direction, double v, double z_m) const;
  void add_parapet(Mesh& mesh, double start_u, double direction, double v, double z_m) const;

  Eigen::Vector2d entrance_m_;
  Eigen::Vector2d u_;
  Eigen::Vector2d v_;
  StairSizes sizes_;
};

}  // namespace isobar::simulation
