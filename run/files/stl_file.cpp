// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/stl_file.hpp"

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "run/files/text_file.hpp"

namespace isobar::files {

namespace {

// Binary STL: a header of 80 bytes, the number of triangles, and for each a normal, three corners (twelve
// floats) and two bytes of attributes, little-endian.
constexpr std::size_t kStlHeaderBytes = 80;
constexpr std::size_t kStlCountBytes = 4;
constexpr std::size_t kStlTriangleBytes = 50;
constexpr std::size_t kVectorBytes = 12;

}  // namespace

void write_stl(const std::filesystem::path& file, const std::vector<SurfaceTriangle>& triangles) {
  OutputFile out(file);
  std::array<char, kStlHeaderBytes> header{};
  constexpr std::string_view kTitle =
      "isobar: surfaces [m]";  // must not begin with "solid", as text files do
  std::memcpy(header.data(), kTitle.data(), kTitle.size());
  out.write(header.data(), header.size());
  const auto count = static_cast<std::uint32_t>(triangles.size());
  out.write(&count, sizeof(count));
  for (const SurfaceTriangle& triangle : triangles) {
    std::array<char, kStlTriangleBytes> bytes{};
    const Eigen::Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
    std::memcpy(bytes.data(), normal.data(), kVectorBytes);
    for (std::size_t i = 0; i < triangle.size(); ++i) {
      std::memcpy(bytes.data() + (i + 1) * kVectorBytes, triangle[i].data(), kVectorBytes);
    }
    out.write(bytes.data(), bytes.size());
  }
  out.close();
}

std::vector<SurfaceTriangle> read_stl(const std::filesystem::path& file) {
  const std::string bytes = read_text_file(file);
  if (bytes.size() < kStlHeaderBytes + kStlCountBytes) {
    throw DataError(file.string() + ": is no binary STL: shorter than its header of 84 bytes");
  }
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeaderBytes, sizeof(count));
  const std::size_t expected = kStlHeaderBytes + kStlCountBytes + std::size_t{count} * kStlTriangleBytes;
  if (bytes.size() != expected) {
    throw DataError(file.string() + ": " + std::to_string(count) + " triangles need " +
                    std::to_string(expected) + " bytes, the file has " + std::to_string(bytes.size()));
  }
  std::vector<SurfaceTriangle> triangles(count);
  const char* at = bytes.data() + kStlHeaderBytes + kStlCountBytes;
  for (SurfaceTriangle& triangle : triangles) {
    for (std::size_t i = 0; i < triangle.size(); ++i) {
      std::memcpy(triangle[i].data(), at + (i + 1) * kVectorBytes, kVectorBytes);
      if (!triangle[i].allFinite()) throw DataError(file.string() + ": a corner is not finite");
    }
    at += kStlTriangleBytes;
  }
  return triangles;
}

}  // namespace isobar::files
