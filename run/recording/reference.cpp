// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/reference.hpp"

#include "run/recording/csv_writer.hpp"
#include "run/text/number_text.hpp"
#include "run/text/tum_row.hpp"

namespace isobar::recording {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

std::vector<StampedPose> read_tum(const std::filesystem::path& file) {
  text::TextLines lines(file);
  std::vector<StampedPose> poses;
  while (const auto row = text::next_tum_row(lines)) {
    StampedPose pose;
    pose.stamp_ns = row->stamp_ns;
    pose.T_map_base.linear() = row->attitude.toRotationMatrix();
    pose.T_map_base.translation() = row->position_m;
    poses.push_back(pose);
  }
  return poses;
}

std::string format_tum_row(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) {
  const std::int64_t magnitude_ns = stamp_ns < 0 ? -stamp_ns : stamp_ns;
  const std::string decimals = text::number_text(magnitude_ns % kNsPerSecond);
  std::string row = stamp_ns < 0 ? "-" : "";
  row +=
      text::number_text(magnitude_ns / kNsPerSecond) + "." + std::string(9 - decimals.size(), '0') + decimals;
  const Eigen::Quaterniond q(T_map_base.linear());
  const Eigen::Vector3d& p = T_map_base.translation();
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    row += " " + text::number_text(value);
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

}  // namespace isobar::recording
