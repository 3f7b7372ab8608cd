// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_plan.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/nearest_word.hpp"

namespace isobar::simulation {

namespace {

using Angles = LidarPlan::Angles;

/// first, first + step, …
constexpr Angles ladder(double first, double step) {
  Angles angles{};
  for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = first + step * static_cast<double>(i);
  return angles;
}

/// Two ladders, whose rungs alternate.
constexpr Angles two_ladders(double even, double odd, double step) {
  Angles angles{};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const std::size_t rung = i / 2;
    angles[i] = (i % 2 == 0 ? even : odd) + step * static_cast<double>(rung);
  }
  return angles;
}

/// Groups of lasers that fire at once: 0 0 1 1 … for 2.
constexpr Angles groups_of(std::size_t lasers) {
  Angles slots{};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::size_t group = i / lasers;
    slots[i] = static_cast<double>(group);
  }
  return slots;
}

/// The values again and again.
template <std::size_t kCount>
constexpr Angles repeated(const std::array<double, kCount>& values) {
  Angles angles{};
  for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = values[i % kCount];
  return angles;
}

/// Velodyne. VLP-16 data sheet 63-9229: "range accuracy up to +-3 cm (typical)". Glennie, Kusari, Facchin 2016,
/// "Calibration and stability analysis of the VLP-16": noise of 1 to 1.5 cm, bias of about 1 cm per laser. User
/// manual 63-9243: returns from less than about 0.4 m are unreliable; 55.296 us a cycle, 2.304 us a laser.
constexpr LidarPlan vlp16() {
  LidarPlan plan;
  plan.name = "VLP-16";
  plan.product = 0x22;
  plan.slot_s = 1e-9 * 2'304;
  plan.slot = groups_of(1);
  plan.elevation_deg = two_ladders(-15.0, 1.0, 2.0);
  return plan;
}

/// Puck Hi-Res, manual 63-9318: 20 deg in 16 steps.
constexpr LidarPlan vlp16_hi_res() {
  LidarPlan plan = vlp16();
  plan.name = "VLP-16 Hi-Res";
  plan.product = 0x24;
  plan.elevation_deg = two_ladders(-10.0, 2.0 / 3.0, 4.0 / 3.0);
  return plan;
}

/// HDL-32E, manual 63-9113: 32 lasers from -30.67 to 10.67 deg, 46.08 us a cycle, 1.152 us a laser.
constexpr LidarPlan hdl32e() {
  LidarPlan plan = vlp16();
  plan.name = "HDL-32E";
  plan.product = 0x21;
  plan.lasers = 32;
  plan.cycles = 12;
  plan.cycle_s = 1e-9 * 46'080;
  plan.slot_s = 1e-9 * 1'152;
  plan.elevation_deg = two_ladders(-92.0 / 3.0, -28.0 / 3.0, 4.0 / 3.0);
  return plan;
}

/// VLP-32C, manual 63-9325: two lasers at once; table of elevations and azimuth offsets.
constexpr LidarPlan vlp32c() {
  LidarPlan plan = vlp16();
  plan.name = "VLP-32C";
  plan.product = 0x28;
  plan.lasers = 32;
  plan.cycles = 12;
  plan.slot = groups_of(2);
  plan.distance_unit_m = 0.004;
  plan.elevation_deg = {-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                        -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                        -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                        -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
  plan.azimuth_ahead_deg = {1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                            -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                            1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4};
  plan.range.reach_m = 150.0;
  return plan;
}

/// Hesai XT32: 15 … -16 deg in steps of 1, 50 us a cycle, laser n fires (0.368 + 1.512 n) us after its start. Data
/// sheet: accuracy +-1 cm, precision 0.5 cm (1 sigma), 0.05 to 120 m. y is at azimuth 0.
constexpr LidarPlan xt32() {
  LidarPlan plan;
  plan.name = "XT32";
  plan.maker = LidarMaker::kHesai;
  plan.lasers = 32;
  plan.cycles = 8;
  plan.cycle_s = 50e-6;
  plan.first_s = 0.368e-6;
  plan.slot_s = 1.512e-6;
  plan.slot = groups_of(1);
  plan.elevation_deg = ladder(15.0, -1.0);
  plan.zero_deg = -90.0;
  plan.one_azimuth = true;
  plan.distance_unit_m = 0.004;
  plan.range = {0.05, 120.0, 0.004, 0.007, 0.004, 0.0015, 0.0};
  return plan;
}

/// Every second laser of an XT32.
constexpr LidarPlan xt16() {
  LidarPlan plan = xt32();
  plan.name = "XT16";
  plan.lasers = 16;
  plan.slot_s = 3.024e-6;
  plan.elevation_deg = ladder(15.0, -2.0);
  return plan;
}

/// RoboSense RS-Helios-16P: 30 deg, 55.56 us a cycle, firing times by table; beams stagger by 3.8 deg and start
/// 35 mm from the axis. Data sheet: accuracy +-2 cm, 0.2 to 150 m.
constexpr LidarPlan helios16p() {
  LidarPlan plan;
  plan.name = "Helios-16P";
  plan.maker = LidarMaker::kRobosense;
  plan.port = 6699;
  plan.info_port = 7788;
  plan.product = 6;
  plan.cycle_s = 55.56e-6;
  plan.slot_s = 1e-6;
  plan.slot = {0.0,   3.15,  6.30,  9.45,  13.26, 17.08, 20.56, 23.71,
               26.53, 27.77, 31.49, 32.73, 36.46, 38.94, 41.42, 43.91};
  plan.elevation_deg = ladder(15.0, -2.0);
  plan.azimuth_ahead_deg = repeated(std::array{3.8, -3.8});
  plan.distance_unit_m = 0.0025;
  plan.origin_radius_m = 0.03498;
  plan.range = {0.2, 150.0, 0.007, 0.012, 0.006, 0.003, 0.0};
  return plan;
}

/// RoboSense RS-LiDAR-16: -15 … -1 and 15 … 1 deg, 55.5 us a cycle, 2.8 us a laser, 38 mm from the axis.
constexpr LidarPlan rs_lidar16() {
  LidarPlan plan = helios16p();
  plan.name = "RS-LiDAR-16";
  plan.info_port = 0;
  plan.product = 1;
  plan.cycle_s = 55.5e-6;
  plan.slot_s = 2.8e-6;
  plan.slot = groups_of(1);
  plan.azimuth_ahead_deg = {};
  for (std::size_t i = 0; i < 8; ++i) {
    plan.elevation_deg[i] = -15.0 + 2.0 * static_cast<double>(i);
    plan.elevation_deg[i + 8] = 15.0 - 2.0 * static_cast<double>(i);
  }
  plan.distance_unit_m = 0.005;
  plan.origin_radius_m = 0.03825;
  return plan;
}

/// Ouster with 32 beams, 1024 columns at 10 Hz; beams stagger in four columns, as the 128 of which they are every
/// fourth. Data sheet of the OS1: 1 cm (1 sigma) to 20 m, 0.5 to 120 m. Transforms as in metadata of the sensor.
constexpr LidarPlan ouster32(std::string_view name, double half_field_deg, double radius_m, double height_m,
                             double reach_m) {
  LidarPlan plan;
  plan.name = name;
  plan.maker = LidarMaker::kOuster;
  plan.sweep = LidarSweep::kColumns;
  plan.port = 7502;
  plan.lasers = 32;
  plan.cycles = 16;
  plan.columns = 1'024;
  plan.cycle_s = 0.1 / 1'024.0;
  plan.elevation_deg = ladder(half_field_deg, -2.0 * half_field_deg / 31.0);
  plan.azimuth_ahead_deg = repeated(std::array{4.23, 1.41, -1.41, -4.23});
  plan.zero_deg = 180.0;
  plan.distance_unit_m = 0.001;
  plan.origin_radius_m = radius_m;
  plan.origin_height_m = height_m;
  plan.range = {0.5, reach_m, 0.007, 0.012, 0.006, 0.003, 0.0};
  return plan;
}

/// Livox Mid-360: 4 lasers, 200 000 points a second, 96 points a packet, -7 … 52 deg. Data sheet: 1 sigma of the
/// range at most 2 cm at 10 m, of the angle below 0.15 deg; 70 m at 80 % reflectivity, 0.1 m near.
constexpr LidarPlan mid360() {
  LidarPlan plan;
  plan.name = "Mid-360";
  plan.maker = LidarMaker::kLivox;
  plan.sweep = LidarSweep::kRosette;
  plan.port = 56'301;
  plan.lasers = 4;
  plan.cycles = 24;
  plan.cycle_s = 20e-6;
  plan.slot_s = 5e-6;
  plan.slot = groups_of(1);
  plan.distance_unit_m = 0.001;
  plan.range = {0.1, 70.0, 0.010, 0.020, 0.005, 0.003, 0.0013};
  return plan;
}

constexpr std::array kPlans{vlp16(),
                            vlp16_hi_res(),
                            vlp32c(),
                            hdl32e(),
                            xt16(),
                            xt32(),
                            rs_lidar16(),
                            helios16p(),
                            ouster32("OS0", 45.0, 0.02767, 0.03618, 75.0),
                            ouster32("OS1", 22.5, 0.015806, 0.03618, 120.0),
                            ouster32("OS2", 11.25, 0.013762, 0.074296, 240.0),
                            mid360()};

}  // namespace

std::span<const LidarPlan> lidar_plans() { return kPlans; }

const LidarPlan& find_lidar_plan(std::string_view name) {
  const auto at =
      std::find_if(kPlans.begin(), kPlans.end(), [name](const auto& plan) { return plan.name == name; });
  if (at != kPlans.end()) return *at;
  std::string known;
  std::vector<std::string> names;
  for (const LidarPlan& plan : kPlans) {
    names.emplace_back(plan.name);
    known += (known.empty() ? "" : ", ") + names.back();
  }
  throw UsageError("lidar: \"" + std::string(name) + "\" is unknown" + did_you_mean(name, names) +
                   "; known are " + known);
}

}  // namespace isobar::simulation
