// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/ply_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "core/errors.hpp"

namespace isobar::files {

namespace {

// Limits far above any real file, so that a damaged header ends in an error and not in a huge allocation.
constexpr std::size_t kMaxHeaderLines = 200;
constexpr std::size_t kMaxVertexBytes = 1024;

struct ScalarType {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::array<ScalarType, 16> kScalarTypes{{{"char", 1},
                                                   {"int8", 1},
                                                   {"uchar", 1},
                                                   {"uint8", 1},
                                                   {"short", 2},
                                                   {"int16", 2},
                                                   {"ushort", 2},
                                                   {"uint16", 2},
                                                   {"int", 4},
                                                   {"int32", 4},
                                                   {"uint", 4},
                                                   {"uint32", 4},
                                                   {"float", 4},
                                                   {"float32", 4},
                                                   {"double", 8},
                                                   {"float64", 8}}};

/// Byte positions of the coordinates in a vertex.
struct VertexLayout {
  std::uint64_t count = 0;              ///< vertices in the file
  std::size_t bytes = 0;                ///< size of a vertex
  std::array<std::size_t, 3> offset{};  ///< of x, y, z
  std::array<std::size_t, 3> width{};   ///< 4: float, 8: double, 0: missing
};

struct PlyHeader {
  VertexLayout layout;
  std::string element;  ///< the one whose properties are being listed
  bool is_binary = false;
  bool is_complete = false;
};

std::size_t scalar_bytes(std::string_view type) {
  for (const ScalarType& known : kScalarTypes) {
    if (known.name == type) return known.bytes;
  }
  return 0;
}

void add_property(VertexLayout& layout, const std::string& type, const std::string& title,
                  const std::string& where) {
  const std::size_t bytes = scalar_bytes(type);
  if (bytes == 0) throw DataError(where + "a vertex property of type '" + type + "' is not understood");
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  const auto axis = static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), title) - kAxes.begin());
  if (axis < kAxes.size()) {
    if (!type.starts_with("float") && type != "double")
      throw DataError(where + title + " must be float or double");
    layout.offset[axis] = layout.bytes;
    layout.width[axis] = bytes;
  }
  layout.bytes += bytes;
  if (layout.bytes > kMaxVertexBytes) throw DataError(where + "a vertex has too many properties");
}

std::uint64_t element_count(const std::string& word, const std::string& where) {
  std::uint64_t count = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, count);
  if (error != std::errc{} || stop != end) {
    throw DataError(where + "'" + word + "' is not a number of elements");
  }
  return count;
}

bool is_ply_magic(const std::string& line) { return line == "ply" || line == "ply\r"; }

/// Applies one header line to the layout.
void apply_header_line(const std::string& line, const std::string& where, PlyHeader& header) {
  std::istringstream words(line);
  std::string keyword;
  std::string first;
  std::string second;
  words >> keyword >> first >> second;
  if (keyword == "format") header.is_binary = first == "binary_little_endian";
  if (keyword == "element") {
    if (header.element.empty() && first != "vertex") {
      throw DataError(where + "the first element must be 'vertex'");
    }
    header.element = first;
    const std::uint64_t count = element_count(second, where);
    if (first == "vertex") header.layout.count = count;
  }
  if (keyword == "property" && header.element == "vertex") add_property(header.layout, first, second, where);
  header.is_complete = keyword == "end_header";
}

/// Reads up to and including "end_header". Vertices must be the first element; others may follow.
VertexLayout read_ply_header(std::istream& in, const std::string& name) {
  PlyHeader header;
  std::string line;
  for (std::size_t number = 1; !header.is_complete; ++number) {
    if (number > kMaxHeaderLines || !std::getline(in, line)) throw DataError(name + ": has no 'end_header'");
    const std::string where = name + ":" + std::to_string(number) + ": ";
    if (number == 1 && !is_ply_magic(line)) throw DataError(where + "is not a PLY file");
    apply_header_line(line, where, header);
  }
  if (!header.is_binary) throw DataError(name + ": the format must be binary_little_endian 1.0");
  const auto& width = header.layout.width;
  if (std::count(width.begin(), width.end(), 0U) > 0) throw DataError(name + ": has no x, y, z");
  return header.layout;
}

float coordinate(const char* vertex, std::size_t offset, std::size_t width) {
  if (width == sizeof(double)) {
    double value = 0.0;
    std::memcpy(&value, vertex + offset, sizeof(value));
    return static_cast<float>(value);
  }
  float value = 0.0F;
  std::memcpy(&value, vertex + offset, sizeof(value));
  return value;
}

std::array<float, 3> coordinates(const char* vertex, const VertexLayout& layout) {
  std::array<float, 3> point{};
  for (std::size_t axis = 0; axis < point.size(); ++axis) {
    point[axis] = coordinate(vertex, layout.offset[axis], layout.width[axis]);
  }
  return point;
}

bool is_finite(const std::array<float, 3>& point) {
  return std::all_of(point.begin(), point.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

PlyPoints read_ply_points(const std::filesystem::path& file, std::size_t max_points) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw DataError(file.string() + ": cannot be read");
  const VertexLayout layout = read_ply_header(in, file.string());
  const auto data_begin = static_cast<std::uint64_t>(in.tellg());
  const std::uint64_t data_bytes = std::filesystem::file_size(file) - data_begin;
  if (layout.count > data_bytes / layout.bytes) {
    throw DataError(file.string() + ": holds fewer than the " + std::to_string(layout.count) +
                    " vertices of its header");
  }
  const std::uint64_t stride =
      max_points == 0 ? 1 : std::max<std::uint64_t>(1, (layout.count + max_points - 1) / max_points);
  PlyPoints result{{}, layout.count};
  result.points.reserve(static_cast<std::size_t>(layout.count / stride + 1));
  std::vector<char> vertex(layout.bytes);
  for (std::uint64_t i = 0; i < layout.count; ++i) {
    in.read(vertex.data(), static_cast<std::streamsize>(vertex.size()));
    if (!in) throw DataError(file.string() + ": cannot be read to its end");
    if (i % stride != 0) continue;
    const std::array<float, 3> point = coordinates(vertex.data(), layout);
    if (is_finite(point)) result.points.push_back(point);
  }
  return result;
}

}  // namespace isobar::files
