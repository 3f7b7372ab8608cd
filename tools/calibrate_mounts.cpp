// SPDX-License-Identifier: BSD-3-Clause
// `isobar calibrate mounts`: the mount of the lidar from recordings of a robot that drives and turns.
#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/mounts/corrected_mount.hpp"
#include "core/mounts/mount_text.hpp"
#include "tools/commands.hpp"
#include "tools/mount_replay.hpp"
#include "tools/progress.hpp"
#include "tools/report/number_text.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

using report::fixed;

// Replays of one recording at most, and the change between two that ends them [rad]: a fifth of the least sigma.
constexpr int kMostReplays = 4;
constexpr double kSettledRad = 0.01 * kRadPerDeg;
// Chi-square of roll and pitch of two recordings, at 99.9 % (2 degrees of freedom): beyond, a mount has moved.
constexpr double kSameMount = 13.8;

struct MountOptions {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path config;
};

/// One recording after the last of its replays.
struct MountOfRecording {
  std::string name;
  MountReplay replay;
};

/// The error with which the next replay registers: yaw only where it was found.
Eigen::Vector3d usable_error(const MountEstimate& estimate) {
  if (estimate.verdict != MountVerdict::kFound) return Eigen::Vector3d::Zero();
  Eigen::Vector3d error_rad = estimate.error_rad;
  if (!estimate.yaw_found) error_rad.z() = 0.0;
  return error_rad;
}

/// Replays with the mount of the replay before until it stays: a wrong mount distorts the map that measures it.
MountOfRecording calibrate_recording(const std::filesystem::path& recording, const Config& config) {
  MountOfRecording out;
  out.name = recording.filename().empty() ? recording.parent_path().filename() : recording.filename();
  Eigen::Vector3d used_rad = Eigen::Vector3d::Zero();
  for (int i = 0; i < kMostReplays; ++i) {
    Progress progress("replaying " + out.name + ", pass " + std::to_string(i + 1));
    out.replay =
        replay_for_mount(recording, config, used_rad, [&](double fraction) { progress.update(fraction); });
    progress.finish();
    const Eigen::Vector3d error_rad = usable_error(out.replay.estimate);
    if ((error_rad - used_rad).cwiseAbs().maxCoeff() < kSettledRad) break;
    used_rad = error_rad;
  }
  return out;
}

std::string with_sigma(double value_rad, double sigma_rad) {
  return fixed(value_rad / kRadPerDeg, 2) + " +- " + fixed(sigma_rad / kRadPerDeg, 2);
}

/// Why a recording is not used; empty: it is.
std::string refusal(const MountReplay& replay) {
  const MountEstimate& estimate = replay.estimate;
  if (replay.registered == 0) return "no scan was registered";
  if (estimate.verdict == MountVerdict::kInconsistent) {
    return "scans and gyro contradict each other in " + fixed(100.0 * estimate.outlier_share, 0) +
           " % of the last half minute: the registration is lost, or the ground moved (elevator); use "
           "another recording, "
           "or its part before that";
  }
  if (estimate.verdict == MountVerdict::kUnknown) {
    return "roll and pitch are not observable: the robot turned by " + fixed(replay.turn_deg, 0) +
           " deg on " + fixed(replay.way_m, 0) + " m; record two turns of 90 deg or more between walls";
  }
  return "";
}

void print_recording(const MountOfRecording& recording) {
  const MountReplay& replay = recording.replay;
  const Eigen::Vector3d sigma_rad = replay.estimate.sigma_rad();
  std::printf("%-28s %6.0f m %7.0f deg   roll %s, pitch %s, yaw %s\n", recording.name.c_str(), replay.way_m,
              replay.turn_deg, with_sigma(replay.estimate.error_rad.x(), sigma_rad.x()).c_str(),
              with_sigma(replay.estimate.error_rad.y(), sigma_rad.y()).c_str(),
              with_sigma(replay.estimate.error_rad.z(), sigma_rad.z()).c_str());
  const std::string reason = refusal(replay);
  if (!reason.empty()) std::printf("warning: %s is not used: %s\n", recording.name.c_str(), reason.c_str());
}

/// @throws DataError when the mounts in the manifests, or the mounts that were found, differ
void require_one_mount(const std::vector<MountOfRecording>& used) {
  const MountOfRecording& first = used.front();
  for (const MountOfRecording& other : used) {
    if (other.replay.configured_rpy_deg != first.replay.configured_rpy_deg) {
      throw DataError(first.name + " and " + other.name +
                      " have different lidar.rpy_deg in recording.toml: calibrate them one by one");
    }
    const MountEstimate& a = first.replay.estimate;
    const MountEstimate& b = other.replay.estimate;
    const Eigen::Vector2d difference = (a.error_rad - b.error_rad).head<2>();
    const Eigen::Matrix2d covariance = (a.covariance_rad2 + b.covariance_rad2).topLeftCorner<2, 2>();
    if (difference.dot(covariance.inverse() * difference) > kSameMount) {
      throw DataError(first.name + " and " + other.name +
                      " contradict each other in roll or pitch: has the lidar been moved between them?");
    }
  }
}

/// Mean of all recordings, weighted by their information; the result keeps the smallest sigma, since systematic errors
/// are common to all.
MountEstimate mean_of(const std::vector<MountOfRecording>& used) {
  MountEstimate out = used.front().replay.estimate;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const MountOfRecording& recording : used) {
    const MountEstimate& one = recording.replay.estimate;
    const Eigen::Matrix3d weight = one.covariance_rad2.inverse();
    information += weight;
    sum += weight * one.error_rad;
    if (one.covariance_rad2.trace() < out.covariance_rad2.trace()) out = one;
  }
  out.error_rad = information.inverse() * sum;
  return out;
}

void print_scale(const char* what, const char* rule, const ScaleEstimate& scale) {
  if (!std::isfinite(scale.sigma)) return;
  std::printf("%s: %s x %s +- %s\n", what, rule, fixed(scale.scale, 4).c_str(),
              fixed(scale.sigma, 4).c_str());
}

void print_result(const MountEstimate& found, const Eigen::Vector3d& configured_rpy_deg) {
  const Eigen::Vector3d sigma_rad = found.sigma_rad();
  std::printf("\nerror of the lidar's mount [deg], about the axes of base_link: roll %s, pitch %s, yaw %s\n",
              with_sigma(found.error_rad.x(), sigma_rad.x()).c_str(),
              with_sigma(found.error_rad.y(), sigma_rad.y()).c_str(),
              with_sigma(found.error_rad.z(), sigma_rad.z()).c_str());
  if (!found.yaw_found) {
    std::printf(
        "warning: yaw is not observable and is kept: it needs wheels and some straight metres, or turns on "
        "stairs and ramps\n");
  }
  print_scale("distance of the wheels", "true =", found.wheel_distance);
  print_scale("turn of the wheels", "true =", found.wheel_turn);
  const Eigen::Vector3d error_rad = usable_error(found);
  const bool right = (found.error_rad.cwiseAbs().array() < 2.0 * sigma_rad.array()).all();
  std::printf("\n%s\n",
              right ? "The configured mount is right within two sigma. The line for isobar.toml would be:"
                    : "The line for isobar.toml, and for [lidar] in recording.toml:");
  std::printf("lidar.rpy_deg = %s  # was %s\n",
              rpy_text(corrected_rpy_deg(configured_rpy_deg, error_rad)).c_str(),
              rpy_text(configured_rpy_deg).c_str());
}

void run_calibrate_mounts(const MountOptions& options) {
  const Config config = options.config.empty() ? Config{} : load_config(options.config);
  std::vector<MountOfRecording> used;
  std::string last_refusal;
  for (const auto& path : options.recordings) {
    MountOfRecording recording = calibrate_recording(path, config);
    print_recording(recording);
    const std::string reason = refusal(recording.replay);
    if (reason.empty()) {
      used.push_back(std::move(recording));
    } else {
      last_refusal = recording.name + ": " + reason;
    }
  }
  if (used.empty()) throw DataError("no recording tells the mount; " + last_refusal);
  require_one_mount(used);
  print_result(mean_of(used), used.front().replay.configured_rpy_deg);
}

}  // namespace

void add_calibrate_mounts_command(CLI::App& calibrate) {
  const auto [command, options] = add_subcommand<MountOptions>(
      calibrate, "mounts", "Find the rotation of the lidar in base_link from recordings",
      run_calibrate_mounts);
  command.footer(
      "Replays each recording with 6-DOF until the mount stays. Roll and pitch against the IMU come from "
      "turns, yaw "
      "from\nstraight drives against the wheels. 100 m indoors with two turns of 90 deg or more suffice:\n\n"
      "  isobar calibrate mounts monday tuesday");
  command.add_option("RECORDING", options.recordings, "recording folders of one robot with one mount")
      ->required();
  command.add_option("--config", options.config,
                     "TOML file; its sensors and mounts are replaced by the recordings'");
}

}  // namespace isobar::tools
