// SPDX-License-Identifier: BSD-3-Clause
#include "core/floors/first_arrival.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/floors/floor_numbers.hpp"

namespace isobar {

namespace {

constexpr double kWayM = 0.5;
constexpr std::int64_t kTimeNs = 500'000'000;
constexpr double kStillM = 0.06;  // range of heights of a level way; noise of the poses is 1 to 2 cm
constexpr double kBandM = 0.12;   // of ground around the height of the robot; less than a step
constexpr double kFootM = 2.0;    // around the robot: ground whose slope is that of the place
constexpr double kOnItM = 0.4;    // the robot is still on a floor
constexpr std::size_t kMostDropped = 100;

double gap_between_m(const Floor& a, const Floor& b) {
  return std::max({a.lowest_m - b.highest_m, b.lowest_m - a.highest_m, 0.0});
}

/// Ground around a place, at its height.
struct GroundAround {
  double area_m2 = 0.0;
  double height_m = 0.0;  ///< mean
  double slope = 1.0;     ///< of that within kFootM, by least squares; 1 where there is too little
  Eigen::AlignedBox2d extent_m;
};

/// Moments of z = a x + b y + c.
class SlopeFit {
 public:
  void add(const Eigen::Vector2d& plan, double z) {
    const Eigen::Vector3d row(plan.x(), plan.y(), 1.0);
    normal_ += row * row.transpose();
    right_ += row * z;
    ++count_;
  }
  [[nodiscard]] double slope() const {
    constexpr int kLeastColumns = 24;  // 1.5 m^2
    if (count_ < kLeastColumns) return 1.0;
    const Eigen::Vector3d plane = normal_.ldlt().solve(right_);
    return plane.allFinite() ? plane.head<2>().norm() : 1.0;
  }

 private:
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

// True for a height that is a multiple of the building's storeys from a floor: neither landings nor cabins stop there.
bool is_storeys_off(const std::vector<Floor>& floors, double height_m) {
  constexpr double kSlackM = 0.25;
  const double storey = storey_m(floors);
  if (storey == 0.0) return false;
  return std::any_of(floors.begin(), floors.end(), [&](const Floor& floor) {
    const double off_m = std::abs(height_m - floor.height_m);
    return std::abs(off_m - std::round(off_m / storey) * storey) <= kSlackM;
  });
}

GroundAround ground_around(const GroundColumns& ground, const Eigen::Vector2d& plan, double ground_m) {
  constexpr double kColumnM = GroundColumns::kColumnM;
  const ColumnIndex middle = GroundColumns::column_of({plan.x(), plan.y(), 0.0});
  const auto reach = static_cast<std::int32_t>(FirstArrival::kReachM / kColumnM);
  GroundAround around;
  SlopeFit foot;
  double sum = 0.0;
  for (std::int32_t y = -reach; y <= reach; ++y) {
    for (std::int32_t x = -reach; x <= reach; ++x) {
      for (const GroundColumns::Surface& surface : ground.at({middle.x + x, middle.y + y})) {
        const double off_m = static_cast<double>(surface.height_m) - ground_m;
        if (surface.count < GroundColumns::kLeastPoints || std::abs(off_m) > kBandM) continue;
        const Eigen::Vector2d offset = Eigen::Vector2d(x, y) * kColumnM;
        around.area_m2 += kColumnM * kColumnM;
        sum += off_m;
        around.extent_m.extend(plan + offset);
        if (offset.norm() <= kFootM) foot.add(offset, off_m);
      }
    }
  }
  const double columns = around.area_m2 / (kColumnM * kColumnM);
  around.height_m = ground_m + (columns > 0.0 ? sum / columns : 0.0);
  around.slope = foot.slope();
  return around;
}

}  // namespace

// Only the last half metre or half second is kept, whichever is shorter, and one place before it.
void FirstArrival::drive_to(std::int64_t stamp_ns, const Eigen::Vector3d& p_map_base) {
  if (!way_.empty() && stamp_ns <= way_.back().stamp_ns) way_.clear();
  way_.push_back({stamp_ns, p_map_base});
  const auto is_enough = [this](const Place& first) {
    return way_.back().stamp_ns - first.stamp_ns >= kTimeNs ||
           (way_.back().p_map_base - first.p_map_base).head<2>().norm() >= kWayM;
  };
  while (way_.size() > 2 && is_enough(way_[1])) way_.pop_front();
}

bool FirstArrival::is_level() const {
  if (way_.size() < 3) return false;
  const auto [low, high] = std::minmax_element(way_.begin(), way_.end(), [](const Place& a, const Place& b) {
    return a.p_map_base.z() < b.p_map_base.z();
  });
  const Place& first = way_.front();
  const bool is_long = way_.back().stamp_ns - first.stamp_ns >= kTimeNs ||
                       (way_.back().p_map_base - first.p_map_base).head<2>().norm() >= kWayM;
  return is_long && high->p_map_base.z() - low->p_map_base.z() <= kStillM;
}

bool FirstArrival::open(const GroundColumns& ground, Floors& floors) {
  if (floor_ || floors.floors.empty() || !is_level()) return false;
  const Eigen::Vector3d& p_map_base = way_.back().p_map_base;
  Floor floor;
  floor.height_m = floor.lowest_m = floor.highest_m = p_map_base.z() - floors.base_height_m;
  const bool is_far = std::all_of(floors.floors.begin(), floors.floors.end(), [&floor](const Floor& other) {
    return !other.is_terrain && gap_between_m(other, floor) >= kLowestStoreyM;
  });
  if (!is_far) return false;
  const GroundAround around = ground_around(ground, p_map_base.head<2>(), floor.height_m);
  const bool is_wide = around.area_m2 >= kLeastAreaM2 &&
                       around.extent_m.sizes().maxCoeff() >= kLeastExtentM &&
                       around.slope <= FloorConfig().most_level_slope;
  if (!is_wide && !is_storeys_off(floors.floors, floor.height_m)) return false;
  if (is_wide) {
    floor.lowest_m = std::min(floor.height_m, around.height_m);
    floor.highest_m = std::max(floor.height_m, around.height_m);
    floor.height_m = around.height_m;
  }
  floor.area_m2 = around.area_m2;
  floor.extent_m = around.extent_m;
  floor.driven_m = kWayM;
  floor.is_provisional = true;
  floor_ = floor;
  if (insert(floors)) return true;
  floor_.reset();
  return false;
}

// False, and nothing is changed, where a provisional floor that was dropped had the number.
bool FirstArrival::insert(Floors& floors) {
  std::vector<Floor> with = floors.floors;
  const auto above = std::find_if(with.begin(), with.end(),
                                  [this](const Floor& other) { return other.height_m > floor_->height_m; });
  const auto place = above - with.begin();
  with.insert(above, *floor_);
  number_floors(with, floors.start_m);
  const Floor& added = with[static_cast<std::size_t>(place)];
  const bool is_taken = std::any_of(dropped_.begin(), dropped_.end(), [&added](const Floor& other) {
    return other.number == added.number && gap_between_m(other, added) > kOnItM;
  });
  if (is_taken) return false;
  floor_->number = added.number;
  floors.floors = std::move(with);
  return true;
}

void FirstArrival::renew(Floors& floors) {
  if (!floor_) return;
  const bool is_found = std::any_of(floors.floors.begin(), floors.floors.end(), [this](const Floor& other) {
    return gap_between_m(other, *floor_) < FloorConfig().least_storey_m;
  });
  const double ground_m = way_.back().p_map_base.z() - floors.base_height_m;
  const bool has_left = std::abs(ground_m - floor_->height_m) > kOnItM;
  if (!is_found && !has_left && insert(floors)) return;
  if (!is_found && dropped_.size() < kMostDropped) dropped_.push_back(*floor_);
  floor_.reset();
}

}  // namespace isobar
