// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/cloud_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "core/errors.hpp"

namespace isobar::bench {

namespace {

/// Byte offsets of x, y and z in a record.
struct Layout {
  std::size_t record_bytes = 0;
  std::array<std::size_t, 3> offset{};
  std::size_t point_count = 0;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& rule) {
  throw DataError(file.string() + ": " + rule);
}

/// Header of a PCD file, up to and including its DATA line.
class PcdHeader {
 public:
  PcdHeader(std::istream& stream, const std::filesystem::path& file) : file_(file) {
    std::string line;
    while (std::getline(stream, line)) {
      std::istringstream words(line);
      std::string key;
      words >> key;
      if (key == "FIELDS") read(words, fields_);
      if (key == "SIZE") read(words, sizes_);
      if (key == "TYPE") read(words, types_);
      if (key == "COUNT") read(words, counts_);
      if (key == "POINTS") words >> points_;
      if (key == "DATA") {
        words >> data_;
        return;
      }
    }
  }

  [[nodiscard]] Layout layout() const {
    if (data_ != "binary") refuse(file_, "DATA: must be \"binary\" (got \"" + data_ + "\")");
    const bool complete = !fields_.empty() && sizes_.size() == fields_.size() &&
                          types_.size() == fields_.size() &&
                          (counts_.empty() || counts_.size() == fields_.size());
    if (!complete) refuse(file_, "FIELDS, SIZE, TYPE and COUNT must have the same number of entries");
    Layout layout;
    layout.point_count = points_;
    std::array<bool, 3> found{};
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const std::size_t axis = std::string("xyz").find(fields_[i]);
      if (axis < 3 && fields_[i].size() == 1) {
        if (sizes_[i] != 4 || types_[i] != "F") refuse(file_, fields_[i] + ": must be a four-byte float");
        layout.offset.at(axis) = layout.record_bytes;
        found.at(axis) = true;
      }
      layout.record_bytes += sizes_[i] * (counts_.empty() ? 1 : counts_[i]);
    }
    if (!found[0] || !found[1] || !found[2]) refuse(file_, "FIELDS: must include x, y and z");
    return layout;
  }

 private:
  template <class Value>
  static void read(std::istream& words, std::vector<Value>& values) {
    for (Value value; words >> value;) values.push_back(value);
  }

  const std::filesystem::path& file_;
  std::vector<std::string> fields_, types_;
  std::vector<std::size_t> sizes_, counts_;
  std::size_t points_ = 0;
  std::string data_;
};

bool before(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::string left = a.filename().string();
  const std::string right = b.filename().string();
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto number_at = [&](const std::string& text, std::size_t& i) {
    const std::size_t start = std::min(text.find_first_not_of('0', i), text.size());
    for (i = start; i < text.size() && is_digit(text[i]);) ++i;
    return text.substr(start, i - start);
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < left.size() && j < right.size()) {
    if (is_digit(left[i]) && is_digit(right[j])) {
      const std::string m = number_at(left, i);
      const std::string n = number_at(right, j);
      if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
    } else if (left[i] != right[j]) {
      return left[i] < right[j];
    } else {
      ++i;
      ++j;
    }
  }
  return left.size() - i < right.size() - j;
}

}  // namespace

void read_cloud(const std::filesystem::path& file, Scan& scan) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file, "cannot be read");
  Layout layout{4 * sizeof(float), {0, 4, 8}, std::filesystem::file_size(file) / (4 * sizeof(float))};
  if (file.extension() == ".pcd") layout = PcdHeader(stream, file).layout();
  std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  if (bytes.size() < layout.point_count * layout.record_bytes || layout.point_count == 0) {
    refuse(file, "must hold " + std::to_string(layout.point_count) + " points (at least one)");
  }
  const std::size_t stride = (layout.point_count + Scan::kMaxPoints - 1) / Scan::kMaxPoints;
  scan.point_count = 0;
  for (std::size_t i = 0; i < layout.point_count; i += stride) {
    std::array<float, 3> p{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::memcpy(&p.at(axis), &bytes[i * layout.record_bytes + layout.offset.at(axis)], sizeof(float));
    }
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
    scan.points[scan.point_count++] = {p[0], p[1], p[2], 0, 0, 0};
  }
}

std::vector<std::filesystem::path> cloud_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path extension = entry.path().extension();
    if (extension == ".pcd" || extension == ".bin") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), before);
  return files;
}

}  // namespace isobar::bench
