// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/cloud_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

#include "core/errors.hpp"

namespace isobar::recording {
namespace {

constexpr std::string_view kCloudMagic = "ISOCLOUD";
constexpr std::size_t kMostFields = 256;
constexpr std::size_t kMostNameBytes = 255;

template <typename Value>
void put(std::string& to, Value value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

/// Fields of a record, one after the other; past the end zeros, and ok() is false.
class RecordBytes {
 public:
  explicit RecordBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <typename Value>
  Value get() {
    Value value{};
    const auto from = take(sizeof(Value));
    if (!from.empty()) std::memcpy(&value, from.data(), sizeof(Value));
    return value;
  }
  std::span<const std::uint8_t> take(std::size_t size) {
    if (!ok_ || size > bytes_.size()) {
      ok_ = false;
      return {};
    }
    const auto part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
  }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  bool ok_ = true;
};

std::uint32_t sum_of(std::uint32_t before, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(before, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

bool parse_cloud(std::span<const std::uint8_t> bytes, CloudRecord& cloud) {
  RecordBytes from(bytes);
  cloud.stamp_ns = from.get<std::int64_t>();
  cloud.shift_ns = from.get<std::int64_t>();
  for (std::uint32_t* part : {&cloud.width, &cloud.height, &cloud.point_step, &cloud.row_step}) {
    *part = from.get<std::uint32_t>();
  }
  cloud.is_bigendian = from.get<std::uint8_t>() != 0;
  const auto fields = std::size_t{from.get<std::uint16_t>()};
  if (fields > kMostFields) return false;
  cloud.fields.resize(fields);
  for (CloudRecordField& field : cloud.fields) {
    field.offset = from.get<std::uint32_t>();
    field.datatype = from.get<std::uint8_t>();
    const auto name = from.take(from.get<std::uint8_t>());
    field.name.assign(name.begin(), name.end());
  }
  const auto data = from.take(from.get<std::uint32_t>());
  cloud.data.assign(data.begin(), data.end());
  return from.ok() && from.left() == 0;
}

}  // namespace

CloudFileWriter::CloudFileWriter(const std::filesystem::path& file) : file_(file) {
  put(head_.append(kCloudMagic), kCloudFileVersion);
  file_.write(head_);
}

bool CloudFileWriter::write(const CloudRecord& cloud) {
  if (cloud.fields.size() > kMostFields || cloud.data.size() > kMostCloudBytes / 2) return false;
  head_.clear();
  put(head_, std::uint64_t{0});  // length and check sum
  put(head_, cloud.stamp_ns);
  put(head_, cloud.shift_ns);
  for (const std::uint32_t part : {cloud.width, cloud.height, cloud.point_step, cloud.row_step}) {
    put(head_, part);
  }
  put(head_, static_cast<std::uint8_t>(cloud.is_bigendian ? 1 : 0));
  put(head_, static_cast<std::uint16_t>(cloud.fields.size()));
  for (const CloudRecordField& field : cloud.fields) {
    const std::size_t length = std::min(field.name.size(), kMostNameBytes);
    put(head_, field.offset);
    put(head_, field.datatype);
    put(head_, static_cast<std::uint8_t>(length));
    head_.append(field.name, 0, length);
  }
  put(head_, static_cast<std::uint32_t>(cloud.data.size()));
  const std::string_view data(reinterpret_cast<const char*>(cloud.data.data()), cloud.data.size());
  constexpr std::size_t kPrefix = sizeof(std::uint64_t);
  const auto length = static_cast<std::uint32_t>(head_.size() - kPrefix + data.size());
  const std::uint32_t sum = sum_of(sum_of(0, std::string_view(head_).substr(kPrefix)), data);
  std::memcpy(head_.data(), &length, sizeof(length));
  std::memcpy(head_.data() + sizeof(length), &sum, sizeof(sum));
  file_.write(head_);
  file_.write(data);
  return true;
}

CloudFileReader::CloudFileReader(const std::filesystem::path& file) : name_(file.string()), file_(file) {
  const std::size_t size = kCloudMagic.size() + sizeof(kCloudFileVersion);
  if (read(size) != size || std::memcmp(bytes_.data(), kCloudMagic.data(), kCloudMagic.size()) != 0) {
    throw DataError(name_ + ": is no file of clouds");
  }
  std::uint32_t version = 0;
  std::memcpy(&version, bytes_.data() + kCloudMagic.size(), sizeof(version));
  if (version != kCloudFileVersion) {
    throw DataError(name_ + ": is of version " + std::to_string(version) + "; this program reads version 1");
  }
}

std::string CloudFileReader::place() const { return name_ + ": cloud " + std::to_string(records_) + ": "; }

std::size_t CloudFileReader::read(std::size_t size) {
  // In steps: a damaged length must not take the memory that it names.
  constexpr std::size_t kStep = std::size_t{4} << 20U;
  std::size_t used = 0;
  while (used < size) {
    bytes_.resize(std::min(size, used + kStep));
    const std::size_t got = file_.read(reinterpret_cast<char*>(bytes_.data()) + used, bytes_.size() - used);
    if (got == 0) break;
    used += got;
  }
  bytes_.resize(used);
  return used;
}

bool CloudFileReader::next(CloudRecord& cloud) {
  for (;;) {
    const std::size_t got = read(2 * sizeof(std::uint32_t));
    if (got == 0 && file_.damage().empty()) return false;
    ++records_;
    std::uint32_t length = 0;
    std::uint32_t sum = 0;
    const bool has_head = got == 2 * sizeof(std::uint32_t);
    if (has_head) std::memcpy(&length, bytes_.data(), sizeof(length));
    if (has_head) std::memcpy(&sum, bytes_.data() + sizeof(length), sizeof(sum));
    if (!has_head || length > kMostCloudBytes || read(length) != length) {
      tallies_.truncated.add([&] {
        return file_.damage().empty() ? place() + "the file ends within it, or is damaged there"
                                      : file_.damage();
      });
      return false;
    }
    const std::string_view bytes(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    if (sum_of(0, bytes) == sum && parse_cloud(bytes_, cloud)) return true;
    tallies_.damaged.add([&] { return place() + "its check sum is wrong; it is left out"; });
  }
}

}  // namespace isobar::recording
