// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/ply_writer.hpp"

#include <array>
#include <bit>
#include <string>

namespace isobar::files {

namespace {

static_assert(std::endian::native == std::endian::little, "floats are written in the machine's byte order");

/// Header of constant length, so that close() can overwrite it: a comment pads the count.
std::string ply_header(std::uint64_t count, PlyFields fields) {
  constexpr std::size_t kCountDigits = 20;  // of 2^64
  const std::string digits = std::to_string(count);
  return "ply\nformat binary_little_endian 1.0\ncomment isobar map, metres, z up\nelement vertex " + digits +
         "\ncomment " + std::string(kCountDigits - digits.size(), '.') +
         "\nproperty float x\nproperty float y\nproperty float z\n" +
         (fields == PlyFields::kNormalIntensity ? "property float nx\nproperty float ny\nproperty float nz\n"
                                                : "") +
         "property float intensity\nend_header\n";
}

}  // namespace

PlyWriter::PlyWriter(const std::filesystem::path& file, PlyFields fields) : fields_(fields), file_(file) {
  file_.write(ply_header(0, fields_));
}

void PlyWriter::add(float x_m, float y_m, float z_m, float intensity) {
  if (fields_ == PlyFields::kNormalIntensity) {
    const std::array<float, 7> vertex{x_m, y_m, z_m, 0.0F, 0.0F, 0.0F, intensity};
    file_.write(vertex.data(), sizeof(vertex));
  } else {
    const std::array<float, 4> vertex{x_m, y_m, z_m, intensity};
    file_.write(vertex.data(), sizeof(vertex));
  }
  ++count_;
}

void PlyWriter::add(const MapPoint& point) {
  const Eigen::Vector3f p_map = point.p_map.cast<float>();
  const Eigen::Vector3f& normal = point.normal_map;
  if (fields_ == PlyFields::kIntensity) {
    add(p_map.x(), p_map.y(), p_map.z(), point.intensity);
    return;
  }
  const std::array<float, 7> vertex{p_map.x(),
                                    p_map.y(),
                                    p_map.z(),
                                    normal.x(),
                                    normal.y(),
                                    normal.z(),
                                    static_cast<float>(point.intensity)};
  file_.write(vertex.data(), sizeof(vertex));
  ++count_;
}

void PlyWriter::close() {
  if (!file_.is_open()) return;
  file_.seek(0);
  file_.write(ply_header(count_, fields_));
  file_.close();
}

}  // namespace isobar::files
