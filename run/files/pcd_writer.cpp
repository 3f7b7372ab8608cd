// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/pcd_writer.hpp"

#include <array>
#include <bit>
#include <string>

namespace isobar::files {

namespace {

static_assert(std::endian::native == std::endian::little, "floats are written in the machine's byte order");

/// Header of constant length, so that close() can overwrite it: a comment pads the two counts.
std::string pcd_header(std::uint64_t count) {
  constexpr std::size_t kCountDigits = 20;  // of 2^64
  const std::string digits = std::to_string(count);
  return "# .PCD v0.7 - Point Cloud Data file format\n# isobar map, metres, z up\n# " +
         std::string(2 * (kCountDigits - digits.size()), '.') +
         "\nVERSION 0.7\nFIELDS x y z intensity normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4 4\n"
         "TYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH " +
         digits + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + digits + "\nDATA binary\n";
}

}  // namespace

PcdWriter::PcdWriter(const std::filesystem::path& file) : file_(file) { file_.write(pcd_header(0)); }

void PcdWriter::add(const MapPoint& point) {
  const Eigen::Vector3f p_map = point.p_map.cast<float>();
  const Eigen::Vector3f& normal = point.normal_map;
  const std::array<float, 7> fields{p_map.x(),  p_map.y(),  p_map.z(), static_cast<float>(point.intensity),
                                    normal.x(), normal.y(), normal.z()};
  file_.write(fields.data(), sizeof(fields));
  ++count_;
}

void PcdWriter::close() {
  if (!file_.is_open()) return;
  file_.seek(0);
  file_.write(pcd_header(count_));
  file_.close();
}

}  // namespace isobar::files
