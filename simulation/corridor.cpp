// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/corridor.hpp"

#include <algorithm>
#include <cmath>

namespace isobar::simulation {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kDoorHeightM = 2.05;
constexpr double kWallM = 0.2;  // thickness

/// One leg of a corridor with its own coordinates [m]: s along it, l to its left.
class Leg {
 public:
  Leg(const Corridor& corridor, std::size_t index, double z_m)
      : start_(corridor.corners_m[index]),
        along_((corridor.corners_m[index + 1] - start_).normalized()),
        left_(-along_.y(), along_.x()),
        length_m_((corridor.corners_m[index + 1] - start_).norm()),
        half_m_(0.5 * corridor.width_m),
        z_m_(z_m) {
    if (static_cast<int>(index) == corridor.bare_leg) {
      bare_start_m_ = corridor.bare_start_m;
      bare_end_m_ = corridor.bare_end_m;
    }
  }

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double half_m() const { return half_m_; }
  [[nodiscard]] bool bare(double s0, double s1) const { return s0 < bare_end_m_ && s1 > bare_start_m_; }
  [[nodiscard]] Rect rect(double s0, double s1, double l0, double l1) const {
    return Rect::around(point(s0, l0), point(s1, l1));
  }
  void box(Mesh& mesh, double s0, double s1, double l0, double l1, double z0, double z1,
           Surface surface) const {
    const Rect plan = rect(s0, s1, l0, l1);
    mesh.box({plan.x0, plan.y0, z_m_ + z0}, {plan.x1, plan.y1, z_m_ + z1}, surface);
  }

 private:
  [[nodiscard]] Vector2d point(double s, double l) const { return start_ + s * along_ + l * left_; }

  Vector2d start_;
  Vector2d along_;
  Vector2d left_;
  double length_m_;
  double half_m_;
  double z_m_;
  double bare_start_m_ = 0.0;
  double bare_end_m_ = -1.0;
};

bool is_free(const Storey& storey, const Rect& rect) {
  return std::none_of(storey.taken.begin(), storey.taken.end(),
                      [&](const Rect& taken) { return taken.overlaps(rect); });
}

/// A door frame, 6 cm wide, on the corridor's wall.
void add_frame(const Leg& leg, double s0, double s1, double side, Mesh& mesh) {
  const double inner = side * leg.half_m();
  const double outer = side * (leg.half_m() - 0.03);
  leg.box(mesh, s0 - 0.06, s0, inner, outer, 0.0, kDoorHeightM + 0.06, Surface::kWood);
  leg.box(mesh, s1, s1 + 0.06, inner, outer, 0.0, kDoorHeightM + 0.06, Surface::kWood);
  leg.box(mesh, s0, s1, inner, outer, kDoorHeightM, kDoorHeightM + 0.06, Surface::kWood);
}

void add_furniture(const Leg& leg, double s0, double s1, double l0, double l1, Mesh& mesh, Random& random) {
  // Cabinets against the side walls and tables in the room.
  const int pieces = random.integer(2, 5);
  for (int i = 0; i < pieces; ++i) {
    const double s = random.uniform(s0 + 0.3, s1 - 1.2);
    const double l = l0 + (l1 - l0) * random.uniform(0.3, 0.75);
    const double depth = std::copysign(random.uniform(0.4, 0.8), l1 - l0);
    const double length = random.uniform(0.6, 1.2);
    if (random.chance(0.4)) {
      leg.box(mesh, s, s + length, l, l + depth, 0.0, random.uniform(0.6, 2.0), Surface::kWood);
    } else {
      leg.box(mesh, s, s + length, l, l + depth, 0.70, 0.74, Surface::kWood);
      leg.box(mesh, s, s + 0.05, l, l + depth, 0.0, 0.70, Surface::kMetal);
      leg.box(mesh, s + length - 0.05, s + length, l, l + depth, 0.0, 0.70, Surface::kMetal);
    }
  }
}

/// An open door with a furnished room behind it, perhaps with a window in the far wall. Returns false if
/// there is no space.
bool add_room(const Leg& leg, double door_s, double door_width, double side, double ceiling_m, Storey& storey,
              Mesh& mesh, Random& random) {
  const double before = random.uniform(0.4, 2.0);
  const double after = random.uniform(0.4, 2.0);
  const double depth = random.uniform(2.8, 5.5);
  const double near_l = side * (leg.half_m() + kWallM);
  const double far_l = near_l + side * depth;
  const double s0 = door_s - before;
  const double s1 = door_s + door_width + after;
  if (!is_free(storey, leg.rect(s0 - 0.1, s1 + 0.1, near_l, far_l + side * 0.4))) return false;
  storey.taken.push_back(leg.rect(s0 - 0.1, s1 + 0.1, side * (leg.half_m() + 0.01), far_l + side * 0.4));
  storey.plan.cut({leg.rect(door_s, door_s + door_width, side * leg.half_m(), near_l), 0.0, kDoorHeightM});
  storey.plan.cut({leg.rect(s0, s1, near_l, far_l), 0.0, ceiling_m});
  if (random.chance(0.6)) {  // an open window: rays leave the building without a return
    const double width = std::min(1.4, s1 - s0 - 0.4);
    const double s = random.uniform(s0 + 0.2, s1 - 0.2 - width);
    storey.plan.cut({leg.rect(s, s + width, far_l, far_l + side * 0.25), 0.9, 2.1});
    storey.plan.cut(
        {leg.rect(s, s + width, far_l + side * 0.25, far_l + side * 0.35), 0.0, 3.0, false, false, true});
  }
  add_furniture(leg, s0, s1, near_l, far_l, mesh, random);
  return true;
}

/// An object on the wall between two doors.
void add_clutter(const Leg& leg, double s0, double s1, double side, Mesh& mesh, Random& random) {
  const double length = random.uniform(0.25, std::min(1.6, s1 - s0));
  const double s = random.uniform(s0, s1 - length);
  const double wall = side * leg.half_m();
  if (random.chance(0.35)) {  // pilaster, floor to ceiling
    leg.box(mesh, s, s + std::min(0.4, length), wall, wall - side * 0.12, 0.0, 3.4, Surface::kConcrete);
  } else if (random.chance(0.6)) {  // cabinet, bench, bin
    leg.box(mesh, s, s + length, wall, wall - side * random.uniform(0.2, 0.32), 0.0, random.uniform(0.4, 1.9),
            Surface::kWood);
  } else {  // board or extinguisher on the wall
    leg.box(mesh, s, s + length, wall, wall - side * random.uniform(0.03, 0.12), random.uniform(0.8, 1.2),
            random.uniform(1.5, 1.9), Surface::kMetal);
  }
}

/// A closed door in a niche of the wall. Returns false if there is no space.
bool cut_niche(const Leg& leg, double s0, double s1, double side, Storey& storey, Random& random) {
  const Rect niche =
      leg.rect(s0, s1, side * leg.half_m(), side * (leg.half_m() + random.uniform(0.06, 0.19)));
  if (!is_free(storey, niche)) return false;
  storey.plan.cut({niche, 0.0, kDoorHeightM});
  storey.taken.push_back(niche);
  return true;
}

void add_side(const Leg& leg, double side, double ceiling_m, Storey& storey, Mesh& mesh, Random& random) {
  const double end = leg.length_m() - leg.half_m() - 0.5;
  double s = leg.half_m() + 0.4;
  while (true) {
    const double gap = random.uniform(0.8, 4.0);
    const double door_s = s + gap;
    const double width = random.uniform(0.85, 1.0);
    if (door_s + width > end) break;
    if (gap > 1.2 && random.chance(0.6) && !leg.bare(s, door_s)) {
      add_clutter(leg, s + 0.15, door_s - 0.15, side, mesh, random);
    }
    s = door_s + width;
    if (leg.bare(door_s - 2.0, s + 2.0)) continue;
    const bool room =
        random.chance(0.35) && add_room(leg, door_s, width, side, ceiling_m - 0.1, storey, mesh, random);
    if (!room && !cut_niche(leg, door_s, s, side, storey, random)) continue;
    add_frame(leg, door_s, s, side, mesh);
  }
}

void add_ceiling(const Leg& leg, double ceiling_m, Mesh& mesh, Random& random) {
  const double spacing = random.uniform(2.4, 4.0);
  const bool beams = random.chance(0.4);
  for (double s = leg.half_m() + 0.5; s + 1.2 < leg.length_m() - leg.half_m(); s += spacing) {
    if (leg.bare(s, s + 1.2)) continue;
    leg.box(mesh, s, s + 1.2, -0.1, 0.1, ceiling_m - 0.07, ceiling_m, Surface::kPlaster);
    if (beams) {
      leg.box(mesh, s + 1.3, s + 1.5, -leg.half_m(), leg.half_m(), ceiling_m - 0.25, ceiling_m,
              Surface::kConcrete);
    }
  }
}

/// The frame of a fire door across the corridor, with its leaves open along the walls.
void add_fire_door(const Leg& leg, double s, double ceiling_m, Mesh& mesh) {
  for (const double side : {-1.0, 1.0}) {
    leg.box(mesh, s, s + 0.15, side * leg.half_m(), side * (leg.half_m() - 0.10), 0.0, ceiling_m,
            Surface::kMetal);
    leg.box(mesh, s + 0.15, s + 1.05, side * (leg.half_m() - 0.04), side * (leg.half_m() - 0.10), 0.0, 2.1,
            Surface::kMetal);
  }
  leg.box(mesh, s, s + 0.15, -leg.half_m(), leg.half_m(), 2.15, ceiling_m, Surface::kMetal);
}

}  // namespace

double Corridor::length_m() const {
  double total = 0.0;
  for (std::size_t i = 0; i < legs(); ++i) total += (corners_m[i + 1] - corners_m[i]).norm();
  return total;
}

Rect Corridor::leg_rect(std::size_t leg) const {
  Rect rect = Rect::around(corners_m[leg], corners_m[leg + 1], 0.5 * width_m);
  // The two ends of the corridor border on a stairwell or an end wall and get no margin. The first and last
  // legs lie along x.
  if (leg == 0) rect.x0 = corners_m.front().x();
  if (leg + 1 == legs()) rect.x1 = corners_m.back().x();
  return rect;
}

Corridor draw_corridor(Random& random, int legs, double length_m) {
  Corridor corridor;
  corridor.width_m = random.uniform(2.05, 2.6);
  corridor.ceiling_m = random.uniform(2.6, 3.3);
  std::vector<double> lengths;
  double total = 0.0;
  for (int i = 0; i < legs; ++i) {
    lengths.push_back(i % 2 == 0 ? random.uniform(0.7, 1.4) : random.uniform(0.4, 0.8));
    total += lengths.back();
  }
  Vector2d at = Vector2d::Zero();
  corridor.corners_m.push_back(at);
  for (int i = 0; i < legs; ++i) {
    const double length = lengths[static_cast<std::size_t>(i)] * length_m / total;
    at += i % 2 == 0 ? Vector2d(length, 0.0) : Vector2d(0.0, random.sign() * length);
    corridor.corners_m.push_back(at);
  }
  const auto longest = std::max_element(lengths.begin(), lengths.end());
  const double longest_m = *longest * length_m / total;
  if (longest_m > 20.0) {  // real buildings have bare stretches
    corridor.bare_leg = static_cast<int>(longest - lengths.begin());
    const double bare_m = std::min(random.uniform(15.0, 25.0), longest_m - 6.0);
    corridor.bare_start_m = random.uniform(3.0, longest_m - 3.0 - bare_m);
    corridor.bare_end_m = corridor.bare_start_m + bare_m;
  }
  return corridor;
}

void add_corridor(const Corridor& corridor, Storey& storey, Mesh& mesh, Random& random) {
  for (std::size_t i = 0; i < corridor.legs(); ++i) {
    storey.taken.push_back(corridor.leg_rect(i));
    storey.plan.cut({corridor.leg_rect(i), 0.0, corridor.ceiling_m});
  }
  for (std::size_t i = 0; i < corridor.legs(); ++i) {
    const Leg leg(corridor, i, storey.z_m);
    add_side(leg, 1.0, corridor.ceiling_m, storey, mesh, random);
    add_side(leg, -1.0, corridor.ceiling_m, storey, mesh, random);
    add_ceiling(leg, corridor.ceiling_m, mesh, random);
    const double s = leg.length_m() * random.uniform(0.3, 0.7);
    if (leg.length_m() > 8.0 && random.chance(0.5) && !leg.bare(s, s + 1.2)) {
      add_fire_door(leg, s, corridor.ceiling_m, mesh);
    }
  }
}

void add_closed_door(const Corridor& corridor, std::size_t leg, double along_m, double side, Storey& storey,
                     Mesh& mesh, Random& random) {
  const Leg on(corridor, leg, storey.z_m);
  const double end_m = along_m + random.uniform(0.85, 1.0);
  if (cut_niche(on, along_m, end_m, side, storey, random)) add_frame(on, along_m, end_m, side, mesh);
}

}  // namespace isobar::simulation
