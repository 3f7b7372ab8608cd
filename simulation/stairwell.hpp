// SPDX-License-Identifier: BSD-3-Clause
// A staircase of two flights with a landing half way up, in a well of its own.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulation/floor_plan.hpp"
#include "simulation/random.hpp"
#include "simulation/route.hpp"

namespace isobar::simulation {

/// Sizes of the steps; usual stairs have 2 * rise + going of about 0.63 m.
struct StairSizes {
  int steps = 17;  ///< of one flight
  double rise_m = 0.17;
  double going_m = 0.29;
  [[nodiscard]] double flight_m() const { return steps * rise_m; }
  [[nodiscard]] double storey_m() const { return 2.0 * flight_m(); }
  static StairSizes draw(Random& random, int steps_low, int steps_high);
};

/// In its own frame u leads away from the corridor's end and v to the side of the upper flight. The lower
/// flight goes up along +u at v = 0, the upper one comes back along -u at v = kLaneGap.
class Stairwell {
 public:
  /// entrance_m: middle of the corridor's end; away: unit vector along an axis; side: +1 puts the upper
  /// flight to the left of `away`, -1 to the right.
  Stairwell(const Eigen::Vector2d& entrance_m, const Eigen::Vector2d& away, double side,
            const StairSizes& sizes);

  [[nodiscard]] Rect rect() const;
  [[nodiscard]] const StairSizes& sizes() const { return sizes_; }
  /// Cuts the well out of the storey below and the storey above.
  void cut_lower(FloorPlan& plan) const;
  void cut_upper(FloorPlan& plan, double ceiling_m) const;
  /// Steps, landing, parapets; z_m is the floor of the lower storey.
  void build(Mesh& mesh, double z_m) const;
  /// From the corridor's end up to the corridor's end one storey higher.
  void route_up(std::vector<Waypoint>& way, double z_m, double speed_m_s) const;
  /// The reverse, z_m is still the floor of the lower storey.
  void route_down(std::vector<Waypoint>& way, double z_m, double speed_m_s) const;

 private:
  static constexpr double kLaneGap = 1.5;      // between the middles of the flights
  static constexpr double kHalfLane = 0.68;    // half the width of a flight
  static constexpr double kLanding = 2.5;      // depth of the landings of the storeys
  static constexpr double kHalfLanding = 2.0;  // depth of the landing half way

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
