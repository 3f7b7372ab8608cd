// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "core/printable_text.hpp"
#include "run/import/point_files.hpp"
#include "run/import/point_text.hpp"

namespace isobar::imports {
namespace {

struct PlyType {
  std::string_view name;
  std::uint8_t datatype;
  std::uint32_t size;
};
constexpr std::array kPlyTypes{
    PlyType{"char", 1, 1},  PlyType{"int8", 1, 1},    PlyType{"uchar", 2, 1},  PlyType{"uint8", 2, 1},
    PlyType{"short", 3, 2}, PlyType{"int16", 3, 2},   PlyType{"ushort", 4, 2}, PlyType{"uint16", 4, 2},
    PlyType{"int", 5, 4},   PlyType{"int32", 5, 4},   PlyType{"uint", 6, 4},   PlyType{"uint32", 6, 4},
    PlyType{"float", 7, 4}, PlyType{"float32", 7, 4}, PlyType{"double", 8, 8}, PlyType{"float64", 8, 8},
};

struct PlyHeader {
  std::string format;
  std::uint64_t points = 0;
};

/// Reads up to end_header; the points must be the first element of the file.
PlyHeader read_ply_header(PointText& text, recording::CloudRecord& cloud) {
  PlyHeader header;
  std::string_view line;
  std::string element;
  if (!text.line(line) || line != "ply") text.fail("does not begin with \"ply\"");
  while (text.line(line)) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "end_header") return header;
    if (words[0] == "format" && words.size() > 1) header.format = words[1];
    if (words[0] == "element" && words.size() == 3) {
      if (element.empty() && words[1] != "vertex") text.fail("its first element is not \"vertex\"");
      element = words[1];
      std::int64_t count = 0;
      const bool good = text::parse_number(words[2], count) && count >= 0;
      if (!good || static_cast<std::uint64_t>(count) > kMostFilePoints)
        text.fail("has no, or too many points");
      if (element == "vertex") header.points = static_cast<std::uint64_t>(count);
    }
    if (words[0] != "property" || element != "vertex") continue;
    const auto type = std::find_if(kPlyTypes.begin(), kPlyTypes.end(), [&](const PlyType& known) {
      return words.size() == 3 && known.name == words[1];
    });
    if (type == kPlyTypes.end()) text.fail("a property of its points has a type that is not read");
    cloud.fields.push_back({std::string(words[2]), cloud.point_step, type->datatype});
    cloud.point_step += type->size;
    if (cloud.point_step > 4'096) text.fail("its points have too many bytes");
  }
  text.fail("has no line end_header");
}

}  // namespace

recording::CloudRecord read_ply(const std::filesystem::path& file, std::uint64_t& stated_points) {
  PointText text(file);
  recording::CloudRecord cloud;
  const PlyHeader header = read_ply_header(text, cloud);
  stated_points = header.points;
  if (cloud.point_step == 0) text.fail("its points have no properties");
  cloud.height = 1;
  if (header.format == "ascii") {
    read_text_points(text, header.points, cloud);
  } else if (header.format.starts_with("binary_")) {
    cloud.is_bigendian = header.format == "binary_big_endian";
    const auto rest = text.rest();
    cloud.width =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(header.points, rest.size() / cloud.point_step));
    const auto used = rest.first(std::size_t{cloud.width} * cloud.point_step);
    cloud.data.assign(used.begin(), used.end());
  } else {
    text.fail("format " + printable(header.format) + " is not read");
  }
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

recording::CloudRecord read_kitti_bin(const std::filesystem::path& file) {
  const PointText text(file);
  const auto bytes = text.rest();
  // KITTI: x, y, z, reflectance 0 … 1. nuScenes ("….pcd.bin"): x, y, z, intensity 0 … 255, ring.
  const bool is_nuscenes = file.stem().extension() == ".pcd";
  recording::CloudRecord cloud;
  cloud.height = 1;
  cloud.point_step = is_nuscenes ? 20 : 16;
  cloud.width = static_cast<std::uint32_t>(bytes.size() / cloud.point_step);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"intensity", 12, 7}};
  if (is_nuscenes) cloud.fields.push_back({"ring", 16, 7});
  cloud.data.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cloud.row_step));
  std::uint32_t far = 0;
  for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step) {
    std::array<float, 4> point{};
    std::memcpy(point.data(), &cloud.data[at], sizeof(point));
    constexpr float kFarthestM = 1'000.0F;
    far += std::hypot(point[0], point[1], point[2]) < kFarthestM ? 0 : 1;  // also of NaN
    if (is_nuscenes) continue;
    point[3] *= 255.0F;
    std::memcpy(&cloud.data[at + 12], &point[3], sizeof(float));
  }
  // Other data sets name other layouts .bin, too.
  if (far > cloud.width / 10) text.fail("is no scan of KITTI's form: its bytes are not four floats a point");
  return cloud;
}

bool is_point_file(const std::filesystem::path& file) {
  const std::string extension = file.extension();
  return extension == ".pcd" || extension == ".ply" || extension == ".bin";
}

recording::CloudRecord read_point_file(const std::filesystem::path& file, std::string* damage) {
  const std::string extension = file.extension();
  std::uint64_t stated_points = 0;
  recording::CloudRecord cloud = extension == ".pcd"   ? read_pcd(file, stated_points)
                                 : extension == ".ply" ? read_ply(file, stated_points)
                                                       : read_kitti_bin(file);
  if (cloud.width == 0) throw DataError(file.string() + ": holds no points");
  if (damage != nullptr && cloud.width < stated_points) {
    *damage = file.string() + ": ends after point " + std::to_string(cloud.width) + " of " +
              std::to_string(stated_points);
  }
  return cloud;
}

}  // namespace isobar::imports
