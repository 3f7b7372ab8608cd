// SPDX-License-Identifier: BSD-3-Clause
// `isobar initial-pose`: tells the running isobard where the robot is.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "core/squared.hpp"
#include "ipc/broker.hpp"
#include "ipc/channel.hpp"
#include "ipc/service_view.hpp"
#include "tools/commands.hpp"
#include "tools/map_parts.hpp"
#include "tools/number_option.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/subcommand.hpp"
#include "tools/wait_until.hpp"

namespace isobar::tools {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Beyond --timeout: attaching and detaching take milliseconds.
constexpr unsigned kHintLimitS = 5;
/// Error of a height that somebody states, 1 sigma [m].
constexpr double kHeightSigmaM = 0.3;

struct HintOptions {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;
  std::optional<double> z_m;
  std::string floor;
  std::filesystem::path map;
  double sigma_m = 0.5;
  double sigma_deg = 15.0;
  double timeout_s = 30.0;
};

/// Entry `initial_pose` of a health report.
struct Answer {
  std::uint64_t given = 0;
  std::string text;
  bool is_refused = false;
  [[nodiscard]] bool is_decided() const { return given > 0 && !text.starts_with("tried"); }
};

/// Nothing without a report; an answer to no hint where none was given.
std::optional<Answer> answer_in(ipc::Subscriber<ipc::HealthReport>& reports) {
  const auto report = reports.take_latest();
  if (!report) return std::nullopt;
  for (std::uint32_t i = 0; i < report->entry_count; ++i) {
    const ipc::HealthEntry& entry = report->entries[i];
    if (std::string_view(entry.name) == "initial_pose") {
      return Answer{static_cast<std::uint64_t>(entry.value), entry.message,
                    entry.level != ipc::HealthLevel::kOk};
    }
  }
  return Answer{};
}

ipc::PoseHint hint_of(const HintOptions& options) {
  ipc::PoseHint hint;
  hint.x_m = options.x_m;
  hint.y_m = options.y_m;
  hint.yaw_rad = std::remainder(options.yaw_deg * kRadPerDeg, 2.0 * kPi);
  hint.has_z = options.z_m.has_value();
  hint.z_m = options.z_m.value_or(0.0);
  hint.covariance[0] = hint.covariance[7] = squared(options.sigma_m);
  if (hint.has_z) hint.covariance[14] = squared(kHeightSigmaM);
  hint.covariance[35] = squared(options.sigma_deg * kRadPerDeg);
  return hint;
}

/// Waits for an answer that `fits`; nothing when the time is over.
template <class Fits>
std::optional<Answer> wait_for_answer(ipc::Subscriber<ipc::HealthReport>& reports, Clock::time_point end,
                                      const Fits& fits) {
  std::optional<Answer> answer;
  const bool found = wait_until(end, [&] {
    answer = answer_in(reports);
    return answer && fits(*answer);
  });
  return found ? answer : std::nullopt;
}

void run_initial_pose(HintOptions options) {
  if (!options.floor.empty()) options.z_m = base_height_on(options.map, options.floor);
  const auto end = Clock::now() + milliseconds(static_cast<std::int64_t>(options.timeout_s * 1e3));
  const ipc::PoseHint hint = hint_of(options);
  if (const char* rule = ipc::implausibility(hint); rule != nullptr) throw UsageError(rule);
  ipc::enter_service_view();
  const HangLimit limit(kHintLimitS + static_cast<unsigned>(options.timeout_s), 69);
  const ipc::Attachment attachment("isobar-initial-pose", milliseconds(2'000));
  ipc::Subscriber<ipc::HealthReport> reports(ipc::topics::kHealth);
  ipc::Publisher<ipc::PoseHint> hints(ipc::topics::kPoseHint);
  const auto before = wait_for_answer(reports, end, [&](const Answer&) { return hints.has_subscribers(); });
  if (!before) throw ServiceError("isobard does not answer; is this a base station?");
  if (!hints.send(hint)) throw ServiceError("no shared memory is free");
  const auto answer = wait_for_answer(
      reports, end, [&](const Answer& now) { return now.given > before->given && now.is_decided(); });
  if (!answer) throw ServiceError("no answer in time: see the entry initial_pose of isobar status --all");
  if (answer->is_refused) throw ServiceError("hint " + answer->text + "; the robot goes on as before");
  std::printf("hint %s\n", answer->text.c_str());
}

}  // namespace

void add_initial_pose_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<HintOptions>(
      app, "initial-pose",
      "Tell the running isobard where the robot is: it goes on from there if the scans match",
      run_initial_pose);
  command.add_option("X", options.x_m, "x of base_link in the map frame [m]")->required();
  command.add_option("Y", options.y_m, "y [m]")->required();
  command.add_option("YAW", options.yaw_deg, "heading, counterclockwise from the map's x [deg]")->required();
  CLI::Option* z = command.add_option("--z", options.z_m,
                                      "height of base_link [m]; default: where the robot believes to be");
  CLI::Option* map = command.add_option("--map", options.map,
                                        "folder of the run or of its map, for the floors; may be written");
  command
      .add_option("--floor", options.floor,
                  "number or name of the floor, which tells the height (`isobar map floors`)")
      ->needs(map)
      ->excludes(z);
  command
      .add_option("--sigma", options.sigma_m,
                  "error of X and Y, 1 sigma [m]; twice that is searched, 1 to 5 m")
      ->check(number_within(0.01, 10.0))
      ->capture_default_str();
  command
      .add_option("--sigma-yaw", options.sigma_deg, "error of YAW, 1 sigma [deg]; 90 and more: any heading")
      ->check(number_within(1.0, 180.0))
      ->capture_default_str();
  command.add_option("--timeout", options.timeout_s, "longest wait [s]")->capture_default_str();
}

}  // namespace isobar::tools
