// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/run_output.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "core/errors.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"

namespace isobar::files {

namespace {

/// A CSV cell in quotation marks (RFC 4180).
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

RunOutput::RunOutput(const std::filesystem::path& directory, Start start, std::uint32_t session)
    : directory_(directory),
      start_(start),
      session_(session),
      poses_(std::make_unique<PoseWriter>(directory, start, session)) {}

// The lines of the old map frame are tried once more; a disk that still refuses them costs them.
void RunOutput::follow_session(std::uint32_t session) {
  if (session == session_) return;
  auto next = std::make_unique<PoseWriter>(directory_, start_, session);
  try {
    poses_->flush();
  } catch (const ServiceError&) {
    ++dropped_before_;
  }
  dropped_before_ += poses_->dropped_lines();
  poses_ = std::move(next);
  session_ = session;
}

void RunOutput::add_pose(const PoseEstimate& pose, const Prior& prior) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t kReplayBufferBytes = std::size_t{1} << 18;  // few system calls per megabyte
  follow_session(pose.session);
  const bool known = prior.height_source != HeightSource::kNone;
  poses_->add(pose, known ? prior.height_m : kUnknown,
              known ? std::sqrt(prior.height_variance_m2) : kUnknown);
  ++pose_count_;
  registered_ += pose.mode == PoseMode::kRegistered ? 1 : 0;
  from_prior_ += pose.mode == PoseMode::kPriorOnly ? 1 : 0;
  if (start_ == Start::kNew && poses_->pending_bytes() >= kReplayBufferBytes) poses_->flush();
}

MapExport RunOutput::write_map(FileTileStore& store, const MapHeader& header) {
  const auto ply = open_point_file(directory_ / name_of_session(kMapPointsFile, session_));
  MapExport done = export_map(store, header, std::nullopt, *ply);
  ply->close();
  map_points_ = done.points;
  return done;
}

void RunOutput::write_settings(std::string_view toml) const {
  replace_file(directory_ / kSettingsFile, toml);
}

void RunOutput::write_mounts(std::string_view toml) const { replace_file(directory_ / kMountsFile, toml); }

void RunOutput::write_counters(const std::vector<RunCount>& counts) const {
  std::string text = "name,count,first_message\n";
  for (const RunCount& count : counts) {
    text += count.name + "," + std::to_string(count.count) + "," + quoted(count.first_message) + "\n";
  }
  replace_file(directory_ / kCountersFile, text);
}

}  // namespace isobar::files
