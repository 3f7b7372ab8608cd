// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"
#include "core/map/cell_moments.hpp"

namespace isobar {
namespace {

class Section {
 public:
  Section(const char* section, std::vector<Setting>& settings)
      : prefix_(std::string(section) + "."), settings_(settings) {}
  void add(const char* name, Setting::Target target, const char* unit, double lowest, double highest,
           const char* doc) {
    settings_.push_back({prefix_ + name, target, unit, lowest, highest, doc});
  }

 private:
  std::string prefix_;
  std::vector<Setting>& settings_;
};

void add_matching(RegistrationConfig& r, Section& s) {
  s.add("min_range_m", &r.min_range_m, "m", 0.0, 5.0, "Nearer returns come from the robot itself.");
  s.add("max_range_m", &r.max_range_m, "m", 5.0, 300.0,
        "Farther returns are not used: their spacing and error are too large.");
  s.add("map_voxel_m", &r.map_voxel_m, "m", 0.02, 0.5, "Points kept for the map: one a voxel of this edge.");
  s.add("sample_points", &r.sample_points, "", 200, 20'000,
        "Points that take part in the ICP. More cost time and gain little.");
  s.add("first_distance_m", &r.first_distance_m, "m", 0.2, 5.0,
        "Largest distance to the map in the first iteration; the prior's uncertainty is added.");
  s.add("last_distance_m", &r.last_distance_m, "m", 0.1, 2.0,
        "The same in the last iteration. At least the edge of a map cell.");
  s.add("max_iterations", &r.max_iterations, "", 1, 50, "Iterations at most.");
  s.add("convergence_m", &r.convergence_m, "m", 1e-5, 0.1, "The iteration stops when a step is below this …");
  s.add("convergence_deg", &r.convergence_deg, "deg", 1e-4, 1.0, "… and below this.");
  s.add("min_residual_scale_m", &r.min_residual_scale_m, "m", 0.005, 0.5,
        "Smallest scale of the robust loss: the noise of lidar and map.");
}

void add_weights(RegistrationConfig& r, Section& s) {
  s.add("correlated_pairs", &r.correlated_pairs, "", 1.0, 100.0,
        "Pairs that carry as much information as one independent pair: neighbours are correlated.");
  s.add("normal_error_deg", &r.normal_error_deg, "deg", 0.0, 10.0,
        "Error of the map's normals: it fakes information along a corridor, which is taken away.");
  s.add("degenerate_information", &r.degenerate_information, "", 0.0, 0.3,
        "A direction with less information a pair is degenerate. 1/3 is a scan that constrains all alike.");
  s.add("height_error_m", &r.height_error_m, "m", 0.0, 1.0,
        "Error of height between a scan and the map when pressure fixes it.");
  s.add("attitude_error_deg", &r.attitude_error_deg, "deg", 0.0, 10.0,
        "Error of roll and pitch when gravity fixes them.");
  s.add("step_distance_error", &r.step_distance_error, "", 0.0, 1.0,
        "Error of dead reckoning as a share of the distance: slip and scale of wheels.");
  s.add("step_translation_floor_m", &r.step_translation_floor_m, "m", 1e-4, 1.0,
        "Smallest error of a step's translation.");
  s.add("step_rotation_floor_deg", &r.step_rotation_floor_deg, "deg", 1e-3, 10.0,
        "Smallest error of a step's rotation.");
  s.add("step_rotation_share", &r.step_rotation_share, "", 0.0, 1.0,
        "Error of a step's rotation as a share of the turn: clocks of lidar and IMU differ by milliseconds.");
  s.add("free_acceleration_m_s2", &r.free_acceleration_m_s2, "m/s^2", 0.1, 20.0,
        "Without wheels: how much the velocity changes at random.");
  s.add("velocity_memory_s", &r.velocity_memory_s, "s", 0.1, 100.0,
        "Without wheels: time in which a velocity that scans do not confirm dies away.");
  s.add("altitude_prior_error_m", &r.altitude_prior_error_m, "m", 0.01, 10.0,
        "Error of the height prediction of the ...-altitude methods. Wide: the ICP is free in z.");
}

void add_acceptance(RegistrationConfig& r, Section& s) {
  s.add("min_pairs", &r.min_pairs, "", 10, 1'000, "Pairs needed.");
  s.add("min_overlap", &r.min_overlap, "", 0.0, 1.0, "Share of the sampled points that must find the map.");
  s.add("gate_sigmas", &r.gate_sigmas, "", 2.0, 100.0,
        "A correction of more than this many standard deviations of the prior is refused …");
  s.add("gate_translation_m", &r.gate_translation_m, "m", 0.01, 5.0, "… if it is also more than this …");
  s.add("gate_rotation_deg", &r.gate_rotation_deg, "deg", 0.1, 90.0, "… or more than this.");
}

}  // namespace

void add_registration_settings(RegistrationConfig& registration, std::vector<Setting>& settings) {
  Section section("registration", settings);
  add_matching(registration, section);
  add_weights(registration, section);
  add_acceptance(registration, section);
}

void add_map_settings(MapConfig& map, std::vector<Setting>& settings) {
  Section s("map", settings);
  settings.push_back({.key = "map.matcher",
                      .target = &map.matcher,
                      .doc =
                          "How a point finds its plane of the map. plane-hash: that of the cell it is in, "
                          "else the nearest one. nearest: always the nearest one, by k-d trees; the paper's.",
                      .choices = matcher_choices()});
  s.add("cell_m", &map.cell_m, "m", 0.1, 1.0,
        "Edge of a plane cell. Smaller follows finer indoor detail, larger needs fewer cells outdoors.");
  s.add("radius_m", &map.radius_m, "m", 20.0, 200.0, "Tiles farther from the robot leave memory.");
  s.add("update_distance_m", &map.update_distance_m, "m", 0.0, 2.0,
        "The map takes a scan when the robot moved this far since the last one it took …");
  s.add("update_angle_deg", &map.update_angle_deg, "deg", 0.0, 45.0, "… or turned this far …");
  s.add("update_interval_s", &map.update_interval_s, "s", 0.1, 60.0,
        "… or this long ago: things move while the robot stands …");
  s.add("update_overlap", &map.update_overlap, "", 0.0, 1.0,
        "… or when less than this share of the scan found the map: the place is new. Of scans less than "
        "0.2 s apart each gives a part of its points, in turns, if at least half of it found the map.");
  s.add("freeze_observations", &map.freeze_observations, "", 8, CellMoments::kMostPoints,
        "Observations after which a cell's plane no longer changes: the oldest pose counts, which keeps "
        "drift out.");
  s.add("max_thickness_m", &map.max_thickness_m, "m", 0.01, 0.2,
        "Largest thickness of a cell that counts as a plane. The noise of a VLP-16 is 0.01 to 0.03.");
  s.add("max_normal_deviation_deg", &map.max_normal_deviation_deg, "deg", 0.5, 15.0,
        "Largest standard deviation of a normal's direction. Worse ones are not matched.");
  s.add("see_through_limit", &map.see_through_limit, "", 0, 50,
        "Points seen through this often leave the map: people who walked on. 0 keeps everything.");
  s.add("see_through_margin_m", &map.see_through_margin_m, "m", 0.1, 2.0,
        "A ray must pass a surface by this much to count as seen through.");
  s.add("see_through_range_m", &map.see_through_range_m, "m", 2.0, 100.0,
        "Points farther from the robot are not tested for being seen through.");
}

}  // namespace isobar
