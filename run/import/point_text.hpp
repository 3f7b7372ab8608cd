// SPDX-License-Identifier: BSD-3-Clause
// For the readers of point files: lines of a header, and values as text.
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"
#include "run/import/file_bytes.hpp"
#include "run/recording/cloud_file.hpp"
#include "run/text/number_text.hpp"

namespace isobar::imports {

/// The bytes of a whole point file, read from the front.
class PointText {
 public:
  explicit PointText(const std::filesystem::path& file) : name_(file.string()) {
    FileBytes bytes(file);
    if (!bytes.read(bytes.size(), bytes_))
      throw DataError(name_ + ": is longer than 512 MiB, or cannot be read");
  }
  [[noreturn]] void fail(const std::string& rule) const { throw DataError(name_ + ": " + rule); }

  /// The next line without its end; false at the end of the file.
  bool line(std::string_view& to) {
    if (at_ >= bytes_.size()) return false;
    const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const std::string_view rest(begin, bytes_.size() - at_);
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    to = rest.substr(0, end);
    if (to.ends_with('\r')) to.remove_suffix(1);
    at_ += std::min(end + 1, rest.size());
    return true;
  }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return std::span(bytes_).subspan(at_); }

 private:
  std::string name_;
  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Words between blanks.
inline std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

/// Appends a number as a value of a datatype of sensor_msgs/PointField; saturates nothing: values out of range become 0.
inline void append_value(std::vector<std::uint8_t>& to, double value, std::uint8_t datatype) {
  const auto put = [&to](auto number) {
    const std::size_t at = to.size();
    to.resize(at + sizeof(number));
    std::memcpy(&to[at], &number, sizeof(number));
  };
  const auto whole = [value](double least, double most) {
    return value >= least && value <= most ? value : 0.0;
  };
  switch (datatype) {
    case 1:
      return put(static_cast<std::int8_t>(whole(-128, 127)));
    case 2:
      return put(static_cast<std::uint8_t>(whole(0, 255)));
    case 3:
      return put(static_cast<std::int16_t>(whole(-32768, 32767)));
    case 4:
      return put(static_cast<std::uint16_t>(whole(0, 65535)));
    case 5:
      return put(static_cast<std::int32_t>(whole(-2147483648.0, 2147483647.0)));
    case 6:
      return put(static_cast<std::uint32_t>(whole(0, 4294967295.0)));
    case 7:
      return put(static_cast<float>(value));
    default:
      return put(value);
  }
}

/// Reads rows of numbers as points; rows that are short or hold words are left out.
inline void read_text_points(PointText& text, std::uint64_t points, recording::CloudRecord& cloud) {
  std::string_view line;
  for (std::uint64_t i = 0; i < points && text.line(line);) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    ++i;
    if (words.size() < cloud.fields.size()) continue;
    const std::size_t before = cloud.data.size();
    bool good = true;
    for (std::size_t k = 0; k < cloud.fields.size() && good; ++k) {
      double value = 0.0;
      good = text::parse_number(words[k], value);
      append_value(cloud.data, value, cloud.fields[k].datatype);
    }
    if (!good) cloud.data.resize(before);
  }
  cloud.width = static_cast<std::uint32_t>(cloud.data.size() / cloud.point_step);
}

recording::CloudRecord read_pcd(const std::filesystem::path& file, std::uint64_t& stated_points);
recording::CloudRecord read_ply(const std::filesystem::path& file, std::uint64_t& stated_points);
recording::CloudRecord read_kitti_bin(const std::filesystem::path& file);

/// Datatype of sensor_msgs/PointField.
/// @param type 'I', 'U' or 'F'
/// @return 0 for none
[[nodiscard]] inline std::uint8_t point_datatype(char type, std::size_t size) {
  if (type == 'F') return size == 4 ? 7 : size == 8 ? 8 : 0;
  const std::uint8_t first = size == 1 ? 1 : size == 2 ? 3 : size == 4 ? 5 : 0;
  return first == 0 || (type != 'I' && type != 'U')
             ? std::uint8_t{0}
             : static_cast<std::uint8_t>(first + (type == 'U' ? 1 : 0));
}

}  // namespace isobar::imports
