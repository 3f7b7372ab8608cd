// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/reference.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/recording/csv_reader.hpp"
#include "run/recording/csv_writer.hpp"
#include "run/recording/number_text.hpp"
#include "run/recording/text_lines.hpp"

namespace isobar::recording {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

std::size_t split_words(std::string_view line, std::array<std::string_view, kTumColumns>& words) {
  std::size_t count = 0;
  constexpr std::string_view kBlank = " \t";
  for (auto begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlank, begin), line.size());
    if (count < kTumColumns) {
      words[count] = line.substr(begin, end - begin);
    }
    ++count;
    begin = line.find_first_not_of(kBlank, end);
  }
  return count;
}

StampedPose parse_tum_row(const TextLines& lines, std::string_view line) {
  std::array<std::string_view, kTumColumns> words;
  if (split_words(line, words) != kTumColumns) {
    throw DataError(lines.place() + "must have eight columns, t x y z qx qy qz qw");
  }
  StampedPose pose;
  if (!parse_seconds(words[0], pose.stamp_ns)) {
    double seconds = 0.0;  // exponent notation: as exact as a double is
    if (!parse_number(words[0], seconds) || !(std::abs(seconds) < 9e9)) {
      throw DataError(lines.place() + "'" + std::string(words[0]) + "' is no time in seconds");
    }
    pose.stamp_ns = std::llround(seconds * 1e9);
  }
  std::array<double, kTumColumns> v{};
  for (std::size_t i = 1; i < kTumColumns; ++i) {
    if (!parse_number(words[i], v[i]) || !std::isfinite(v[i])) {
      throw DataError(lines.place() + "'" + std::string(words[i]) + "' is no finite number");
    }
  }
  const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  if (!kPlausibleQuaternionNorm.holds(q.norm())) {
    throw DataError(lines.place() + "the quaternion must have norm 1");
  }
  pose.T_map_base.linear() = q.normalized().toRotationMatrix();
  pose.T_map_base.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  return pose;
}

}  // namespace

std::vector<StampedPose> read_tum(const std::filesystem::path& file) {
  TextLines lines(file);
  std::vector<StampedPose> poses;
  std::string_view line;
  while (lines.next(line)) {
    if (lines.too_long()) {
      throw DataError(lines.place() + "the line is too long");
    }
    const std::string_view text = trimmed(line);
    if (!text.empty() && text[0] != '#') {
      poses.push_back(parse_tum_row(lines, text));
    }
  }
  return poses;
}

std::string format_tum_row(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) {
  const std::int64_t magnitude_ns = stamp_ns < 0 ? -stamp_ns : stamp_ns;
  const std::string decimals = number_text(magnitude_ns % kNsPerSecond);
  std::string row = stamp_ns < 0 ? "-" : "";
  row += number_text(magnitude_ns / kNsPerSecond) + "." + std::string(9 - decimals.size(), '0') + decimals;
  const Eigen::Quaterniond q(T_map_base.linear());
  const Eigen::Vector3d& p = T_map_base.translation();
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    row += " " + number_text(value);
  }
  return row + "\n";
}

void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  TextFile out(file);
  out.write("# t x y z qx qy qz qw\n");
  for (const StampedPose& pose : poses) {
    out.write(format_tum_row(pose.stamp_ns, pose.T_map_base));
  }
  out.close();
}

std::vector<Segment> read_segments(const std::filesystem::path& file) {
  CsvReader csv(file, {"t_start_ns", "t_end_ns", "label"});
  std::vector<Segment> segments;
  for (;;) {
    const CsvReader::Row row = csv.next();
    if (row == CsvReader::Row::kEnd) {
      return segments;
    }
    if (row == CsvReader::Row::kBad) {
      throw DataError(csv.bad_row_message());
    }
    Segment segment;
    if (!parse_number(csv.field(0), segment.start_ns) || !parse_number(csv.field(1), segment.end_ns)) {
      throw DataError(csv.lines().place() + "t_start_ns and t_end_ns must be whole numbers");
    }
    if (segment.end_ns < segment.start_ns) {
      throw DataError(csv.lines().place() + "t_end_ns must not be before t_start_ns");
    }
    segment.label = csv.field(2);
    segments.push_back(std::move(segment));
  }
}

}  // namespace isobar::recording
