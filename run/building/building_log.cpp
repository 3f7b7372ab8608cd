// SPDX-License-Identifier: BSD-3-Clause
#include "run/building/building_log.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/plausibility.hpp"
#include "run/tile_store/tile_record.hpp"

namespace isobar::building_log {
namespace {

constexpr std::uint32_t kMagic = 0x474C4F42;      // "BLOG"
constexpr std::uint32_t kMostRecordBytes = 4096;  // the largest is a loop, of 488
constexpr double kLargestM = 1e8;                 // as LocalMap::update()

struct LogHead {
  std::uint32_t magic = kMagic;
  std::uint32_t kind = 0;
  std::uint32_t length = 0;
  std::uint32_t crc = 0;  // of kind, length and the bytes that follow

  [[nodiscard]] std::uint32_t crc_with(std::span<const std::byte> payload) const {
    std::vector<std::byte> bytes(sizeof(kind) + sizeof(length));
    std::memcpy(bytes.data(), &kind, sizeof(kind));
    std::memcpy(bytes.data() + sizeof(kind), &length, sizeof(length));
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return crc32_of(bytes);
  }
};
static_assert(sizeof(LogHead) == 16);

/// Payload of a record: 64-bit integers and doubles.
class Writer {
 public:
  explicit Writer(Kind kind) : kind_(kind) {}
  Writer& put(std::uint64_t value) { return append(&value); }
  Writer& put(std::int64_t value) { return append(&value); }
  Writer& put(double value) { return append(&value); }
  Writer& put(const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    for (int i = 0; i < 3; ++i) put(T.translation()(i));
    return put(q.w()).put(q.x()).put(q.y()).put(q.z());
  }
  Writer& put(const Matrix6d& matrix) {
    for (Eigen::Index i = 0; i < 36; ++i) put(matrix(i));
    return *this;
  }
  Writer& put(const std::optional<AirHeight>& air) {
    const AirHeight value = air.value_or(AirHeight{});
    return put(std::uint64_t{air.has_value()}).put(value.height_m).put(value.variance_m2);
  }
  void append_to(std::vector<std::byte>& bytes) const {
    LogHead head;
    head.kind = static_cast<std::uint32_t>(kind_);
    head.length = static_cast<std::uint32_t>(payload_.size());
    head.crc = head.crc_with(payload_);
    const auto* first = reinterpret_cast<const std::byte*>(&head);
    bytes.insert(bytes.end(), first, first + sizeof(head));
    bytes.insert(bytes.end(), payload_.begin(), payload_.end());
  }

 private:
  Writer& append(const void* value) {
    const auto* first = static_cast<const std::byte*>(value);
    payload_.insert(payload_.end(), first, first + 8);
    return *this;
  }
  Kind kind_;
  std::vector<std::byte> payload_;
};

/// The same in return. A payload that is too short, or a number that is not finite, makes it fail for good.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> payload) : rest_(payload) {}
  [[nodiscard]] bool ended_well() const { return good_ && rest_.empty(); }
  std::uint64_t integer() { return take<std::uint64_t>(); }
  std::int64_t stamp() { return take<std::int64_t>(); }
  double number() {
    const double value = take<double>();
    good_ = good_ && std::isfinite(value);
    return value;
  }
  Eigen::Isometry3d pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) T.translation()(i) = number();
    const double w = number();
    const double x = number();
    const double y = number();
    const Eigen::Quaterniond q(w, x, y, number());
    good_ = good_ && kPlausibleQuaternionNorm.holds(q.norm()) &&
            T.translation().cwiseAbs().maxCoeff() <= kLargestM;
    if (good_) T.linear() = q.normalized().toRotationMatrix();
    return T;
  }
  Matrix6d matrix() {
    Matrix6d matrix;
    for (Eigen::Index i = 0; i < 36; ++i) matrix(i) = number();
    return matrix;
  }
  std::optional<AirHeight> air() {
    const bool has = integer() != 0;
    AirHeight air;
    air.height_m = number();
    air.variance_m2 = number();
    return has ? std::optional(air) : std::nullopt;
  }

 private:
  template <class T>
  T take() {
    T value{};
    good_ = good_ && rest_.size() >= sizeof(T);
    if (!good_) return value;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_ = rest_.subspan(sizeof(T));
    return value;
  }
  std::span<const std::byte> rest_;
  bool good_ = true;
};

bool read_submap(Reader& in, StoredBuilding& building) {
  Submap submap;
  submap.number = static_cast<std::uint32_t>(building.submaps.size());
  const std::uint64_t number = in.integer();
  submap.stamp_ns = in.stamp();
  submap.air = in.air();
  submap.first_way_m = submap.last_way_m = in.number();
  submap.link.T_before_submap = in.pose();
  submap.link.covariance = in.matrix();
  if (!in.ended_well() || number != submap.number) return false;
  building.submaps.push_back(std::move(submap));
  return true;
}

bool read_key(Reader& in, StoredBuilding& building) {
  KeyScan key;
  const std::uint64_t submap = in.integer();
  key.stamp_ns = in.stamp();
  key.way_m = in.number();
  key.T_map_base = in.pose();
  key.map_moves = static_cast<std::uint32_t>(in.integer());
  key.T_submap_base = in.pose();
  key.air = in.air();
  key.scan = in.integer();
  if (!in.ended_well() || submap >= building.submaps.size()) return false;
  building.submaps[submap].last_way_m = key.way_m;
  building.submaps[submap].keys.push_back(std::move(key));
  return true;
}

bool read_loop(Reader& in, StoredBuilding& building) {
  Loop loop;
  loop.submap = in.integer();
  loop.holder = in.integer();
  loop.stamp_ns = in.stamp();
  loop.way_m = in.number();
  loop.T_submap_base = in.pose();
  loop.T_holder_base = in.pose();
  loop.covariance = in.matrix();
  loop.overlap = in.number();
  loop.residual_rms_m = in.number();
  const std::size_t submaps = building.submaps.size();
  if (!in.ended_well() || loop.submap >= submaps || loop.holder >= submaps) return false;
  building.loops.push_back(loop);
  return true;
}

bool read_record(Kind kind, Reader in, LogContent& content) {
  switch (kind) {
    case Kind::kFormat:
      content.format = in.integer();
      return in.ended_well() && content.format == kVersion;
    case Kind::kSubmap:
      return read_submap(in, content.building);
    case Kind::kKey:
      return read_key(in, content.building);
    case Kind::kLoop:
      return read_loop(in, content.building);
    case Kind::kMove:
      content.building.moved_ns.push_back(in.stamp());
      return in.ended_well();
  }
  return false;
}

}  // namespace

void append_format(std::vector<std::byte>& bytes) { Writer(Kind::kFormat).put(kVersion).append_to(bytes); }

void append_submap(const Submap& submap, std::vector<std::byte>& bytes) {
  Writer(Kind::kSubmap)
      .put(std::uint64_t{submap.number})
      .put(submap.stamp_ns)
      .put(submap.air)
      .put(submap.first_way_m)
      .put(submap.link.T_before_submap)
      .put(submap.link.covariance)
      .append_to(bytes);
}

void append_key(std::size_t submap, const KeyScan& key, std::vector<std::byte>& bytes) {
  Writer(Kind::kKey)
      .put(std::uint64_t{submap})
      .put(key.stamp_ns)
      .put(key.way_m)
      .put(key.T_map_base)
      .put(std::uint64_t{key.map_moves})
      .put(key.T_submap_base)
      .put(key.air)
      .put(std::uint64_t{key.scan})
      .append_to(bytes);
}

void append_loop(const Loop& loop, std::vector<std::byte>& bytes) {
  Writer(Kind::kLoop)
      .put(std::uint64_t{loop.submap})
      .put(std::uint64_t{loop.holder})
      .put(loop.stamp_ns)
      .put(loop.way_m)
      .put(loop.T_submap_base)
      .put(loop.T_holder_base)
      .put(loop.covariance)
      .put(loop.overlap)
      .put(loop.residual_rms_m)
      .append_to(bytes);
}

void append_move(std::int64_t stamp_ns, std::vector<std::byte>& bytes) {
  Writer(Kind::kMove).put(stamp_ns).append_to(bytes);
}

LogContent read_log(std::span<const std::byte> bytes) {
  LogContent content;
  std::span<const std::byte> rest = bytes;
  while (rest.size() >= sizeof(LogHead)) {
    LogHead head;
    std::memcpy(&head, rest.data(), sizeof(head));
    const bool fits =
        head.magic == kMagic && head.length <= kMostRecordBytes && rest.size() - sizeof(head) >= head.length;
    if (!fits) break;
    const auto payload = rest.subspan(sizeof(head), head.length);
    if (head.crc != head.crc_with(payload)) break;
    const bool first = content.whole_bytes == 0;
    const auto kind = static_cast<Kind>(head.kind);
    if (first != (kind == Kind::kFormat)) break;
    if (!read_record(kind, Reader(payload), content)) break;
    rest = rest.subspan(sizeof(head) + head.length);
    content.whole_bytes = bytes.size() - rest.size();
  }
  return content;
}

}  // namespace isobar::building_log
