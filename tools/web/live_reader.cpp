// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/live_reader.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "core/geometry.hpp"
#include "core/names.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "run/evaluation/trajectory.hpp"
#include "tools/status/health_reader.hpp"
#include "tools/status/view.hpp"
#include "tools/web/live_settings.hpp"
#include "tools/web/view_json.hpp"

namespace isobar::web {
namespace {

using Json = nlohmann::ordered_json;

/// Poses of viewers: ten a second.
constexpr std::int64_t kPoseIntervalNs = 95'000'000;
/// The health report comes once a second; beyond this isobard hangs.
constexpr std::chrono::seconds kSilence{5};
/// Answers to an action come within seconds; a hint waits for the next scans.
constexpr std::chrono::seconds kAnswerPatience{30};

double sqrt_or_unknown(double variance) { return variance > 0.0 ? std::sqrt(variance) : PoseRow::kUnknown; }

PoseRow row_of(const PoseEstimate& pose, double altimeter_m) {
  const Eigen::Vector3d& place = pose.T_map_base.translation();
  PoseRow row;
  row.stamp_ns = pose.stamp_ns;
  row.x_m = place.x();
  row.y_m = place.y();
  row.z_m = place.z();
  row.yaw_deg = evaluation::yaw_rad(Eigen::Quaterniond(pose.T_map_base.linear())) / kRadPerDeg;
  row.z_sd_m = sqrt_or_unknown(pose.covariance(2, 2));
  row.altimeter_m = altimeter_m;
  row.bias_m = pose.altimeter.bias_m;
  row.bias_sd_m = pose.altimeter.bias_sd_m;
  row.registered = pose.mode == PoseMode::kRegistered;
  return row;
}

Json pose_json(const PoseRow& row, const PoseEstimate& pose) {
  const bool is_lost = pose.lost != LostReason::kNone;
  return {{"stamp_s", rounded(static_cast<double>(row.stamp_ns) * 1e-9, 4)},
          {"x_m", rounded(row.x_m, 3)},
          {"y_m", rounded(row.y_m, 3)},
          {"z_m", rounded(row.z_m, 4)},
          {"yaw_deg", rounded(row.yaw_deg, 2)},
          {"z_sd_m", rounded(row.z_sd_m, 4)},
          {"altimeter_m", rounded(row.altimeter_m, 3)},
          {"bias_m", rounded(row.bias_m, 4)},
          {"bias_sd_m", rounded(row.bias_sd_m, 4)},
          {"registered", row.registered ? 1 : 0},
          {"session", pose.session},
          {"mode", std::string(kPoseModeNames.name(pose.mode))},
          {"lost", is_lost ? std::string(kLostReasonTexts.name(pose.lost)) : std::string()}};
}

/// A text of another process: its end may be missing.
template <std::size_t Capacity>
std::string text_in(const char (&field)[Capacity]) {  // NOLINT(modernize-avoid-c-arrays)
  return {field, strnlen(field, Capacity)};
}

Json link_json(bool ok, const std::string& text) { return {{"ok", ok}, {"text", text}}; }

}  // namespace

LiveReader::LiveReader(LiveState& live, MapTiles& map, ActionDesk& desk)
    : live_(live), map_(map), desk_(desk) {
  live_.put(Topic::kLink, text_of(link_json(true, "")));
}

void LiveReader::poll(std::size_t viewers) {
  take_poses();
  take_health();
  take_floors();
  take_settings();
  take_map(viewers);
  take_black_box();
  carry_out_orders();
  give_up_waiting();
}

void LiveReader::take_poses() {
  if (const auto prior = priors_.take_latest()) {
    altimeter_m_ = prior->height_source == HeightSource::kNone ? PoseRow::kUnknown : prior->height_m;
  }
  while (const auto pose = poses_.take()) {
    if (session_ != 0 && pose->session != session_) live_.forget_poses();
    session_ = pose->session;
    if (std::abs(pose->stamp_ns - last_pose_ns_) < kPoseIntervalNs) continue;
    last_pose_ns_ = pose->stamp_ns;
    const PoseRow row = row_of(*pose, altimeter_m_);
    live_.add_pose(row, text_of(pose_json(row, *pose)));
  }
}

void LiveReader::take_health() {
  const auto now = Clock::now();
  if (const auto report = reports_.take_latest()) {
    last_report_ = now;
    live_.put(Topic::kLink, text_of(link_json(true, "")));
    live_.put(Topic::kStatus, tools::status_json(*report, tools::HealthReader::age_s(*report)));
    follow_hint(*report);
  }
  if (last_report_ && now - *last_report_ > kSilence) {
    live_.put(Topic::kLink, text_of(link_json(false,
                                              "isobard runs, but has told nothing for more than five "
                                              "seconds: it hangs or was stopped.")));
  }
}

void LiveReader::take_floors() {
  const auto known = known_floors_.take_latest();
  if (known && known->count <= ipc::KnownFloors::kMost) floors_ = *known;
  const auto floor = floor_.take_latest();
  if (floor) current_floor_ = floor->known ? std::optional(floor->number) : std::nullopt;
  if (!known && !floor) return;
  Json json{{"floors", Json::array()}, {"current", nullptr}};
  for (const ipc::KnownFloor& one : std::span(floors_.floors, floors_.count)) {
    if (!std::isfinite(one.z_m)) continue;
    json["floors"].push_back(
        {{"number", one.number}, {"name", text_in(one.name)}, {"z_m", rounded(one.z_m, 2)}});
  }
  if (current_floor_) json["current"] = *current_floor_;
  live_.put(Topic::kFloors, text_of(json));
}

void LiveReader::take_settings() {
  if (const auto description = descriptions_.take_latest()) {
    live_.put(Topic::kSettings, text_of(settings_in(*description)));
  }
}

void LiveReader::take_map(std::size_t viewers) {
  const auto now = Clock::now();
  if (viewers > 0) last_viewer_ = now;
  const bool wanted = last_viewer_ && now - *last_viewer_ < kMapAfterViewer;
  if (!wanted) {
    clouds_.reset();
    draft_.reset();
    return;
  }
  if (!clouds_) clouds_.emplace(ipc::topics::kMapCloud);
  while (const auto piece = clouds_->take()) take_map_piece(*piece);
}

void LiveReader::take_map_piece(const ipc::MapCloud& piece) {
  if (piece.point_count > ipc::MapCloud::kMaxPoints) return;
  if (piece.first_point == 0) {
    draft_.emplace();
    draft_sequence_ = piece.sequence;
    draft_points_ = 0;
  }
  // A piece was lost: the next whole map will do.
  if (!draft_ || piece.sequence != draft_sequence_ || piece.first_point != draft_points_) {
    draft_.reset();
    return;
  }
  for (std::uint32_t i = 0; i < piece.point_count; ++i) {
    const ScanPoint& point = piece.points[i];
    draft_->add(point.x_m, point.y_m, point.z_m, point.intensity);
  }
  draft_points_ += piece.point_count;
  if (draft_points_ < piece.total_points) return;
  if (map_session_ != 0 && map_session_ != piece.session) map_.start_over();
  map_session_ = piece.session;
  map_.replace(std::move(*draft_));
  draft_.reset();
  live_.put(Topic::kMap, text_of(map_json(map_.state())));
}

void LiveReader::carry_out_orders() {
  const auto order = desk_.take();
  if (!order) return;
  asked_ = Clock::now();
  if (order->kind == Order::Kind::kPoseHint) {
    hint_waits_ = hints_.has_subscribers() && hints_.send(order->hint);
    if (!hint_waits_) tell_action("isobard takes no hint: is this a base station?", true);
    return;
  }
  ipc::BlackBoxOrder save;
  save.number = static_cast<std::uint64_t>(monotonic_ns()) ^ static_cast<std::uint64_t>(::getpid());
  ipc::copy_to_field("web", save.reason);
  if (!orders_.has_subscribers() || !orders_.send(save)) {
    tell_action("isobard has no black box: black_box.span_s is 0", true);
    return;
  }
  order_number_ = save.number;
}

void LiveReader::give_up_waiting() {
  if ((order_number_ == 0 && !hint_waits_) || Clock::now() - asked_ < kAnswerPatience) return;
  tell_action(hint_waits_ ? "No answer to the hint yet: it needs scans. See initial pose under Health."
                          : "No answer from the black box: see its line under Health.",
              true);
  order_number_ = 0;
  hint_waits_ = false;
}

void LiveReader::take_black_box() {
  const auto state = black_box_.take_latest();
  if (!state || order_number_ == 0 || state->answered != order_number_) return;
  order_number_ = 0;
  tell_action((state->last_failed ? "Not saved: " : "Saved: ") + text_in(state->last), state->last_failed);
}

void LiveReader::follow_hint(const ipc::HealthReport& report) {
  for (std::uint32_t i = 0; i < std::min(report.entry_count, ipc::HealthReport::kMaxEntries); ++i) {
    const ipc::HealthEntry& entry = report.entries[i];
    if (text_in(entry.name) != "initial_pose") continue;
    const auto given = static_cast<std::uint64_t>(std::max(0.0, entry.value));
    const std::string text = text_in(entry.message);
    const bool is_decided = !text.starts_with("tried");
    if (hint_waits_ && given > hints_given_ && is_decided) {
      hint_waits_ = false;
      tell_action("Hint " + text, entry.level != ipc::HealthLevel::kOk);
    }
    if (!hint_waits_) hints_given_ = given;
  }
}

void LiveReader::tell_action(const std::string& text, bool failed) {
  live_.put(Topic::kAction, text_of(Json{{"text", text}, {"failed", failed}, {"at_ns", monotonic_ns()}}));
}

}  // namespace isobar::web
