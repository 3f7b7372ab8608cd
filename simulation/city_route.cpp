// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/city_route.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isobar::simulation {

using Eigen::Vector2d;

namespace {

constexpr double kAccelerationMS2 = 1.2;
constexpr double kBrakingMS2 = 1.5 * kAccelerationMS2;  // the same factor as in Route::drive()
constexpr double kCornerRadiusM = 4.0;
constexpr double kTurnRateRadS = 0.6;
constexpr double kCornerSpeedMS = kTurnRateRadS * kCornerRadiusM;

/// A small electric vehicle with comfortable accelerations and a turning circle that fits into a crossing.
PlatformLimits vehicle_limits() {
  PlatformLimits limits;
  limits.acceleration_m_s2 = kAccelerationMS2;
  limits.turn_rate_rad_s = kTurnRateRadS;
  limits.corner_radius_m = kCornerRadiusM;
  limits.bend_radius_m = 80.0;
  return limits;
}

/// Distance from the intersection of two lanes at which a vehicle begins to brake for the arc between them.
double braking_m(double speed_m_s) {
  const double way_m = (speed_m_s * speed_m_s - kCornerSpeedMS * kCornerSpeedMS) / (2.0 * kBrakingMS2);
  return std::max(0.0, way_m) + kCornerRadiusM + 0.5;
}

/// Plans a way as a list of crossings.
class Planner {
 public:
  Planner(const CityGrid& grid, Random& random) : grid_(grid), random_(random) {}

  [[nodiscard]] CityWay plan(const CityWayWish& wish) {
    int band = 1;
    int direction = 1;
    bool may_change = false;
    while (length_m_ < wish.new_m) {
      const Crossing at = here();
      const bool at_end = direction > 0 ? at.x >= wish.columns : at.x <= 1;
      if (at_end) {
        while (here().y < band + 2) go(0, 1);
        band += 2;
        direction = -direction;
        may_change = false;
      } else if (may_change && at.y < grid_.rows() - 2 && random_.chance(0.4)) {
        go(0, at.y == band ? 1 : -1);
        may_change = false;
      } else {
        go(direction, 0);
        may_change = true;
      }
    }
    way_.first_old = way_.crossings.size() - 1;
    come_back(length_m_ + wish.return_m, wish.columns);
    return way_;
  }

 private:
  [[nodiscard]] Crossing here() const { return way_.crossings.back(); }

  void go(int dx, int dy) {
    const Crossing next{here().x + dx, here().y + dy};
    length_m_ += (grid_.at(next) - grid_.at(here())).norm();
    way_.crossings.push_back(next);
  }

  /// Way back: for the first half down across the rows, then preferably along streets driven once. Never
  /// turns round.
  void come_back(double until_m, int columns) {
    const double down_m = length_m_ + 0.5 * (until_m - length_m_);
    while (length_m_ < until_m) {
      const Crossing at = here();
      const Crossing before = way_.crossings[way_.crossings.size() - 2];
      Crossing best = at;
      double best_score = -1.0;
      for (const auto& [dx, dy] : {std::pair{0, -1}, {-1, 0}, {1, 0}, {0, 1}}) {
        const Crossing next{at.x + dx, at.y + dy};
        if (next == before || next.x < 1 || next.x > columns || next.y < 1 || next.y > grid_.rows() - 2) {
          continue;
        }
        const bool down = dy < 0 && length_m_ < down_m;
        const double score =
            (down ? 10.0 : 0.0) + (times_driven(way_, at, next) == 1 ? 3.0 : 0.0) + random_.uniform();
        if (score > best_score) {
          best = next;
          best_score = score;
        }
      }
      go(best.x - at.x, best.y - at.y);
    }
  }

  const CityGrid& grid_;
  Random& random_;
  CityWay way_{{{1, 1}}, 0};
  double length_m_ = 0.0;
};

/// Turns the list of crossings into a route, street by street.
class Driver {
 public:
  Driver(const CityGrid& grid, const CityWay& way, Random& random)
      : grid_(grid), way_(way), random_(random), route_(start()) {}

  [[nodiscard]] Route drive() {
    route_.wait(random_.uniform(3.0, 6.0));
    for (std::size_t i = 0; i + 1 < way_.crossings.size(); ++i) drive_street(i);
    route_.drive(pending_);
    route_.wait(3.0);
    return std::move(route_);
  }

 private:
  static constexpr double kStartM = 14.0;  ///< distance of the start from the first crossing

  [[nodiscard]] Vector2d heading(std::size_t i) const {
    return (grid_.at(way_.crossings[i + 1]) - grid_.at(way_.crossings[i])).normalized();
  }
  /// Unit vector to the right of the direction of travel.
  [[nodiscard]] Vector2d right(std::size_t i) const { return {heading(i).y(), -heading(i).x()}; }
  [[nodiscard]] bool turns_after(std::size_t i) const {
    return i + 2 < way_.crossings.size() && std::abs(heading(i).dot(heading(i + 1))) < 0.5;
  }

  [[nodiscard]] Route start() const {
    const Vector2d at = grid_.at(way_.crossings[0]) + kStartM * heading(0) + CityGrid::kLaneM * right(0);
    return {at, 0.0, std::atan2(heading(0).y(), heading(0).x()), vehicle_limits()};
  }

  /// Adds the waypoints from crossing i to crossing i + 1, including the turn there if the way turns.
  void drive_street(std::size_t i) {
    const Vector2d from = grid_.at(way_.crossings[i]);
    const double length_m = (grid_.at(way_.crossings[i + 1]) - from).norm();
    const bool turned = i > 0 && turns_after(i - 1);
    const bool last = i + 2 == way_.crossings.size();
    if (i == 0 || turned) speed_m_s_ = random_.uniform(6.0, 10.0);
    const auto add = [&](double s, double aside_m, double speed_m_s) {
      pending_.push_back({from + s * heading(i) + (CityGrid::kLaneM + aside_m) * right(i), 0.0, speed_m_s});
    };
    double first_m = i == 0 ? kStartM + 12.0 : 14.0;
    if (turned) add(9.0, 0.0, kCornerSpeedMS);
    // The corner is the intersection of the lanes: before the axis of the other street for a right turn,
    // behind it for a left turn.
    const bool turns = turns_after(i);
    const double corner_m = length_m + (turns ? CityGrid::kLaneM * heading(i).dot(right(i + 1)) : 0.0);
    const double last_m = turns ? corner_m - braking_m(speed_m_s_) : length_m - (last ? 15.0 : 12.0);
    const bool stops = !last && random_.chance(0.12);
    // The vehicle wanders by some decimetres, but drives straight before a stop.
    for (; first_m < last_m - 10.0; first_m += random_.uniform(16.0, 26.0)) {
      add(first_m, stops ? 0.0 : random_.uniform(-0.2, 0.2), speed_m_s_);
    }
    add(last_m, 0.0, speed_m_s_);
    if (stops) {
      route_.drive(pending_);
      route_.wait(random_.uniform(2.0, 6.0));
      pending_.clear();
    }
    if (turns) add(corner_m, 0.0, kCornerSpeedMS);
  }

  const CityGrid& grid_;
  const CityWay& way_;
  Random& random_;
  Route route_;
  std::vector<Waypoint> pending_;
  double speed_m_s_ = 8.0;
};

}  // namespace

int rows_for(const CityWayWish& wish) {
  // Every two rows give at least (columns + 1) streets of at least 62 m; plus a margin on both sides.
  const double pair_m = 62.0 * (wish.columns + 1);
  return 2 * static_cast<int>(std::ceil(wish.new_m / pair_m)) + 5;
}

long times_driven(const CityWay& way, const Crossing& a, const Crossing& b) {
  long times = 0;
  for (std::size_t i = 1; i < way.crossings.size(); ++i) {
    const Crossing& p = way.crossings[i - 1];
    const Crossing& q = way.crossings[i];
    if ((p == a && q == b) || (p == b && q == a)) ++times;
  }
  return times;
}

CityWay plan_city_way(const CityGrid& grid, const CityWayWish& wish, Random& random) {
  return Planner(grid, random).plan(wish);
}

Route drive_city_way(const CityGrid& grid, const CityWay& way, Random& random) {
  return Driver(grid, way, random).drive();
}

}  // namespace isobar::simulation
