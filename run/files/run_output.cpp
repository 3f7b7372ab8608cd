// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/run_output.hpp"

#include <cmath>
#include <limits>

#include "run/files/run_layout.hpp"

namespace isobar::files {

namespace {

/// A CSV cell in quotation marks (RFC 4180).
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

RunOutput::RunOutput(const std::filesystem::path& directory)
    : directory_(directory), poses_(directory), map_(directory / kMapPointsFile) {}

void RunOutput::add_pose(const PoseEstimate& pose, const Prior& prior) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const bool known = prior.height_source != HeightSource::kNone;
  poses_.add(pose, known ? prior.height_m : kUnknown, known ? std::sqrt(prior.height_variance_m2) : kUnknown);
  registered_ += pose.mode == PoseMode::kRegistered ? 1 : 0;
  from_prior_ += pose.mode == PoseMode::kPriorOnly ? 1 : 0;
}

MapExport RunOutput::write_map(FileTileStore& store, const MapHeader& header) {
  return export_map(store, header, std::nullopt, map_);
}

void RunOutput::write_settings(std::string_view toml) const {
  write_text_file(directory_ / kSettingsFile, toml);
}

void RunOutput::close(const std::vector<RunCount>& counts) {
  poses_.close();
  map_.close();
  OutputFile file(directory_ / kCountersFile);
  file.write("name,count,first_message\n");
  for (const RunCount& count : counts) {
    file.write(count.name + "," + std::to_string(count.count) + "," + quoted(count.first_message) + "\n");
  }
  file.close();
}

}  // namespace isobar::files
