// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "core/printable_text.hpp"
#include "run/import/point_files.hpp"
#include "run/import/point_text.hpp"

namespace isobar::imports {
namespace {

constexpr std::uint32_t kMostPointBytes = 4'096;

struct PcdColumn {
  std::string name;
  char type = 'F';
  std::size_t size = 4;
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdColumn> columns;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::uint64_t points = 0;
  std::string data;
  std::size_t point_step = 0;
};

std::uint64_t whole_of(const PointText& text, std::string_view word, const char* key) {
  std::int64_t value = 0;
  if (!text::parse_number(word, value) || value < 0) text.fail(std::string(key) + " must be a whole number");
  return static_cast<std::uint64_t>(value);
}

void take_columns(const PointText& text, const std::vector<std::string_view>& words, PcdHeader& header) {
  const std::string key(words[0]);
  if (key == "FIELDS" || key == "COLUMNS") {
    header.columns.assign(words.size() - 1, {});
    for (std::size_t i = 1; i < words.size(); ++i) header.columns[i - 1].name = words[i];
    return;
  }
  if (words.size() != header.columns.size() + 1) text.fail(key + " has another number of words than FIELDS");
  for (std::size_t i = 1; i < words.size(); ++i) {
    PcdColumn& column = header.columns[i - 1];
    if (key == "TYPE") column.type = words[i].front();
    if (key == "SIZE") column.size = whole_of(text, words[i], "SIZE");
    if (key == "COUNT") column.count = whole_of(text, words[i], "COUNT");
  }
}

PcdHeader read_header(PointText& text) {
  PcdHeader header;
  std::string_view line;
  while (header.data.empty()) {
    if (!text.line(line)) text.fail("has no line DATA, so it is no PCD");
    const auto words = words_of(line);
    if (words.size() < 2 || words[0].starts_with('#')) continue;
    const std::string key(words[0]);
    if (key == "FIELDS" || key == "COLUMNS" || key == "TYPE" || key == "SIZE" || key == "COUNT") {
      take_columns(text, words, header);
    }
    if (key == "WIDTH") header.width = whole_of(text, words[1], "WIDTH");
    if (key == "HEIGHT") header.height = whole_of(text, words[1], "HEIGHT");
    if (key == "POINTS") header.points = whole_of(text, words[1], "POINTS");
    if (key == "DATA") header.data = words[1];
  }
  for (const PcdColumn& column : header.columns) {
    if (column.size > 8 || column.count > kMostPointBytes) text.fail("a field is too long");
    header.point_step += column.size * column.count;
  }
  if (header.points == 0 && header.width <= kMostFilePoints && header.height <= kMostFilePoints) {
    header.points = header.width * header.height;
  }
  if (header.point_step == 0 || header.point_step > kMostPointBytes)
    text.fail("its points have no, or too many bytes");
  if (header.points > kMostFilePoints) text.fail("has more than 20 million points");
  return header;
}

/// Decompresses LZF (liblzf's format, as PCL writes it).
std::vector<std::uint8_t> lzf(const PointText& text, std::span<const std::uint8_t> from, std::size_t size) {
  std::vector<std::uint8_t> to;
  to.reserve(std::min<std::size_t>(size, std::size_t{64} << 20U));
  const auto fail = [&text] { text.fail("its compressed points are damaged"); };
  for (std::size_t at = 0; at < from.size();) {
    const std::size_t control = from[at++];
    if (control < 32) {
      const std::size_t literal = control + 1;
      if (literal > from.size() - at || literal > size - to.size()) fail();
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(at),
                from.begin() + static_cast<std::ptrdiff_t>(at + literal));
      at += literal;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7 && at < from.size()) length += from[at++];
    if (at >= from.size()) fail();
    const std::size_t back = ((control & 31U) << 8U | from[at++]) + 1;
    length += 2;
    if (back > to.size() || length > size - to.size()) fail();
    for (std::size_t i = 0; i < length; ++i) to.push_back(to[to.size() - back]);
  }
  if (to.size() != size) fail();
  return to;
}

/// Points of binary_compressed: field by field instead of point by point.
void read_compressed(PointText& text, const PcdHeader& header, recording::CloudRecord& cloud) {
  constexpr std::size_t kSizes = 8;
  const auto rest = text.rest();
  std::uint32_t packed = 0;
  std::uint32_t size = 0;
  if (rest.size() < kSizes) text.fail("ends before its points");
  std::memcpy(&packed, rest.data(), sizeof(packed));
  std::memcpy(&size, rest.data() + sizeof(packed), sizeof(size));
  if (packed > rest.size() - kSizes) text.fail("ends before its points do");
  if (size != header.points * header.point_step) text.fail("holds another number of points than POINTS says");
  const auto columns = lzf(text, rest.subspan(kSizes, packed), size);
  cloud.data.resize(size);
  std::size_t from = 0;
  std::size_t offset = 0;
  for (const PcdColumn& column : header.columns) {
    const std::size_t bytes = column.size * column.count;
    for (std::uint64_t i = 0; i < header.points; ++i, from += bytes) {
      std::memcpy(&cloud.data[i * header.point_step + offset], &columns[from], bytes);
    }
    offset += bytes;
  }
  cloud.width = static_cast<std::uint32_t>(header.points);
}

}  // namespace

recording::CloudRecord read_pcd(const std::filesystem::path& file, std::uint64_t& stated_points) {
  PointText text(file);
  const PcdHeader header = read_header(text);
  stated_points = header.points;
  recording::CloudRecord cloud;
  cloud.height = 1;
  cloud.point_step = static_cast<std::uint32_t>(header.point_step);
  const bool is_text = header.data == "ascii";
  std::uint32_t offset = 0;
  for (const PcdColumn& column : header.columns) {
    const std::uint8_t datatype = point_datatype(column.type, column.size);
    for (std::size_t k = 0; k < column.count; ++k, offset += static_cast<std::uint32_t>(column.size)) {
      // Padding ("_") and arrays are no fields of use; in text each of their values is a word all the same.
      const bool is_field = datatype != 0 && column.name != "_" && column.count == 1;
      if (is_field || is_text) {
        cloud.fields.push_back(
            {is_field ? column.name : "_", offset, datatype == 0 ? std::uint8_t{8} : datatype});
      }
      if (is_text && datatype == 0) text.fail("field " + printable(column.name) + " has an unknown type");
    }
  }
  if (is_text) {
    read_text_points(text, header.points, cloud);
  } else if (header.data == "binary") {
    const auto rest = text.rest();
    cloud.width =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(header.points, rest.size() / header.point_step));
    const auto used = rest.first(std::size_t{cloud.width} * header.point_step);
    cloud.data.assign(used.begin(), used.end());
  } else if (header.data == "binary_compressed") {
    read_compressed(text, header, cloud);
  } else {
    text.fail("DATA " + printable(header.data) + " is not read");
  }
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

}  // namespace isobar::imports
