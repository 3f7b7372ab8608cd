// SPDX-License-Identifier: BSD-3-Clause
// A small recording and folders of runs over it, for tests of the evaluation and the report.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/estimates.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/files/ply_writer.hpp"
#include "run/files/pose_writer.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "tests/run/evaluation/paths.hpp"

namespace isobar::test {

inline std::string tum_text(const evaluation::Trajectory& trajectory) {
  std::string text;
  for (const evaluation::StampedPose& p : trajectory.poses) {
    std::array<char, 300> line{};
    std::snprintf(line.data(), line.size(), "%lld.%09lld %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n",
                  static_cast<long long>(p.stamp_ns / 1'000'000'000),
                  static_cast<long long>(p.stamp_ns % 1'000'000'000), p.position_m.x(), p.position_m.y(),
                  p.position_m.z(), p.attitude.x(), p.attitude.y(), p.attitude.z(), p.attitude.w());
    text += line.data();
  }
  return text;
}

/// Folder of a run whose height drifts by `slope` [m/m], with status and map; its frame is offset from the
/// reference's by (7, 8, 9) m.
inline void write_run(const std::filesystem::path& folder, double slope) {
  files::PoseWriter writer(folder);
  for (const evaluation::StampedPose& p : straight(60.0, 0.1, slope).poses) {
    PoseEstimate pose;
    pose.stamp_ns = p.stamp_ns;
    pose.T_map_base.translation() = p.position_m - Eigen::Vector3d(7, 8, 9);
    pose.covariance(2, 2) = 0.01;
    pose.registration_ms = 20.0 + std::fmod(p.position_m.x(), 3.0);
    writer.add(pose, -9.0, 0.05);
  }
  writer.flush();
  files::PlyWriter map(folder / files::kMapPointsFile);
  for (int i = 0; i < 2000; ++i) map.add(0.03F * static_cast<float>(i) - 7.0F, -8.0F, -9.0F, 1.0F);
  map.close();
}

inline std::filesystem::path write_recording(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  files::write_text_file(folder / "reference.tum", tum_text(straight(60.0, 0.02)));
  files::write_text_file(folder / "segments.csv", "t_start_ns,t_end_ns,label\n" + std::to_string(at_ns(0)) +
                                                      "," + std::to_string(at_ns(60)) + ",flat\n");
  return folder;
}

inline evaluation::EvaluatedRun two_methods(const std::filesystem::path& folder) {
  write_run(folder / "3dof", 0.001);
  write_run(folder / "4dof", 0.05);
  return evaluation::evaluate_methods(evaluation::load_reference(write_recording(folder / "recording")),
                                      {{"", folder / "3dof"}, {"", folder / "4dof"}});
}

}  // namespace isobar::test
