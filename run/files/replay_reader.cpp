// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/errors.hpp"
#include "run/evaluation/text_table.hpp"
#include "run/files/replay_output.hpp"

namespace isobar::files {

namespace {

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

/// Where the coordinates lie in a vertex.
struct VertexLayout {
  std::uint64_t count = 0;
  std::size_t bytes = 0;
  std::array<std::size_t, 3> offset{};
  std::array<std::size_t, 3> width{};  ///< 4: float, 8: double, 0: not there
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
  const std::optional<std::int64_t> count = evaluation::parse_int64(word);
  if (!count || *count < 0) throw DataError(where + "'" + word + "' is not a number of elements");
  return static_cast<std::uint64_t>(*count);
}

/// Reads up to and with "end_header"; only elements behind the vertices may follow them.
VertexLayout read_ply_header(std::istream& in, const std::string& name) {
  VertexLayout layout;
  std::string line;
  std::string element;
  bool is_binary = false;
  for (std::size_t number = 1; number <= kMaxHeaderLines && std::getline(in, line); ++number) {
    std::string where = name;
    where.append(":").append(std::to_string(number)).append(": ");
    std::istringstream words(line);
    std::string keyword;
    std::string first;
    std::string second;
    words >> keyword >> first >> second;
    if (number == 1 && keyword != "ply") throw DataError(where + "is not a PLY file");
    if (keyword == "format") is_binary = first == "binary_little_endian";
    if (keyword == "element") {
      if (element.empty() && first != "vertex") throw DataError(where + "the first element must be 'vertex'");
      element = first;
      const std::uint64_t count = element_count(second, where);
      if (element == "vertex") layout.count = count;
    }
    if (keyword == "property" && element == "vertex") add_property(layout, first, second, where);
    if (keyword != "end_header") continue;
    if (!is_binary) throw DataError(name + ": the format must be binary_little_endian 1.0");
    if (std::count(layout.width.begin(), layout.width.end(), 0U) > 0)
      throw DataError(name + ": has no x, y, z");
    return layout;
  }
  throw DataError(name + ": has no 'end_header'");
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

}  // namespace

std::vector<std::array<float, 3>> read_ply_points(const std::filesystem::path& file, std::size_t max_points,
                                                  std::uint64_t& total) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw DataError(file.string() + ": cannot be read");
  const VertexLayout layout = read_ply_header(in, file.string());
  const auto data_begin = static_cast<std::uint64_t>(in.tellg());
  const std::uint64_t data_bytes = std::filesystem::file_size(file) - data_begin;
  if (layout.count > data_bytes / layout.bytes) {
    throw DataError(file.string() + ": holds fewer than the " + std::to_string(layout.count) +
                    " vertices of its header");
  }
  total = layout.count;
  const std::uint64_t stride =
      max_points == 0 ? 1 : std::max<std::uint64_t>(1, (layout.count + max_points - 1) / max_points);
  std::vector<std::array<float, 3>> points;
  points.reserve(static_cast<std::size_t>(layout.count / stride + 1));
  std::vector<char> vertex(layout.bytes);
  for (std::uint64_t i = 0; i < layout.count; ++i) {
    in.read(vertex.data(), static_cast<std::streamsize>(vertex.size()));
    if (!in) throw DataError(file.string() + ": cannot be read to its end");
    if (i % stride != 0) continue;
    std::array<float, 3> point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = coordinate(vertex.data(), layout.offset[axis], layout.width[axis]);
    }
    if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]))
      points.push_back(point);
  }
  return points;
}

std::vector<StatusRow> parse_status_csv(std::string_view text, const std::string& name) {
  evaluation::CsvReader csv(text, name);
  const std::size_t stamp = csv.required_column("t_ns");
  const auto mode = csv.column("mode");
  const auto method = csv.column("method");
  const auto scan_ms = csv.column("scan_ms");
  const auto altimeter_height = csv.column("altimeter_height_m");
  const auto altimeter_sd = csv.column("altimeter_sd_m");
  const auto sd_z = csv.column("sd_z_m");
  std::vector<StatusRow> rows;
  while (csv.next_row()) {
    StatusRow row;
    row.stamp_ns = csv.int64(stamp);
    if (mode) row.mode = csv.cell(*mode);
    if (method) row.method = csv.cell(*method);
    row.scan_ms = csv.number_or_nan(scan_ms);
    row.altimeter_height_m = csv.number_or_nan(altimeter_height);
    row.altimeter_sd_m = csv.number_or_nan(altimeter_sd);
    row.sd_z_m = csv.number_or_nan(sd_z);
    rows.push_back(std::move(row));
  }
  return rows;
}

ReplayOutput read_replay_output(const std::filesystem::path& directory, std::size_t max_map_points) {
  ReplayOutput output;
  output.directory = directory;
  const std::filesystem::path trajectory_file = directory / "trajectory.tum";
  output.trajectory = evaluation::parse_tum(read_text_file(trajectory_file), trajectory_file.string());
  std::error_code error;
  const std::filesystem::path status_file = directory / "status.csv";
  if (std::filesystem::exists(status_file, error)) {
    output.status = parse_status_csv(read_text_file(status_file), status_file.string());
  }
  const std::filesystem::path map_file = directory / "map.ply";
  if (std::filesystem::exists(map_file, error)) {
    output.map_points = read_ply_points(map_file, max_map_points, output.map_points_total);
  }
  return output;
}

}  // namespace isobar::files
