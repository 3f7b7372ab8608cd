// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/las_writer.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/errors.hpp"

namespace isobar::files {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written in the machine's byte order");

constexpr double kScaleM = 0.001;
constexpr std::size_t kHeaderBytes = 227;
constexpr std::size_t kRecordBytes = 20;

/// Fields one after another, without padding.
class LasBytes {
 public:
  template <typename T>
  LasBytes& put(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return *this;
  }
  /// Text in a field of fixed size, padded with zeros.
  LasBytes& put_text(std::string_view text, std::size_t bytes) {
    bytes_.append(text.substr(0, bytes));
    return put_zeros(bytes - std::min(bytes, text.size()));
  }
  LasBytes& put_zeros(std::size_t bytes) {
    bytes_.append(bytes, '\0');
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace

LasWriter::LasWriter(const std::filesystem::path& file) : name_(file.string()), file_(file) {
  file_.write(header());
}

// "Public Header Block" of the specification; the bounding box is the one of the rounded coordinates.
std::string LasWriter::header() const {
  const auto count = static_cast<std::uint32_t>(count_);
  LasBytes out;
  out.put_text("LASF", 4).put<std::uint16_t>(0).put<std::uint16_t>(0).put_zeros(
      16);                                           // source, encoding, project
  out.put<std::uint8_t>(1).put<std::uint8_t>(2);     // version
  out.put_text("OTHER", 32).put_text("isobar", 32);  // "OTHER": created by neither of the listed processes
  out.put<std::uint16_t>(0).put<std::uint16_t>(0);   // day and year of creation
  out.put<std::uint16_t>(kHeaderBytes).put<std::uint32_t>(kHeaderBytes);  // the points follow at once
  out.put<std::uint32_t>(0);                                              // variable length records
  out.put<std::uint8_t>(0).put<std::uint16_t>(kRecordBytes);
  out.put(count).put(count).put_zeros(std::size_t{4} * 4);  // all points; those of the returns 1 … 5
  for (int axis = 0; axis < 3; ++axis) out.put(kScaleM);
  out.put_zeros(3 * sizeof(double));  // offsets
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    out.put(count_ > 0 ? highest_mm_[axis] * kScaleM : 0.0)
        .put(count_ > 0 ? lowest_mm_[axis] * kScaleM : 0.0);
  }
  return out.bytes();
}

void LasWriter::add(const MapPoint& point) {
  const Eigen::Vector3d p_mm = (point.p_map / kScaleM).array().round();
  const bool fits =
      p_mm.cwiseAbs().maxCoeff() <= static_cast<double>(std::numeric_limits<std::int32_t>::max());
  if (!fits)
    throw DataError(name_ + ": a point lies farther from the origin than LAS can tell in millimetres");
  if (count_ == std::numeric_limits<std::uint32_t>::max()) {
    throw DataError(name_ + ": LAS 1.2 holds no more than 4294967295 points; use --box");
  }
  constexpr std::uint8_t kOnlyReturn = 1U | 1U << 3U;  // return 1 of 1
  const std::array<std::int32_t, 3> x{static_cast<std::int32_t>(p_mm.x()),
                                      static_cast<std::int32_t>(p_mm.y()),
                                      static_cast<std::int32_t>(p_mm.z())};
  // "Normalised" to 16 bits, as the specification demands: 255 becomes 65535.
  const auto intensity = static_cast<std::uint16_t>(point.intensity * 257);
  std::array<char, kRecordBytes> record{};  // class 0, angle 0, user data 0, source 0
  std::memcpy(record.data(), x.data(), sizeof(x));
  std::memcpy(record.data() + 12, &intensity, sizeof(intensity));
  record[14] = static_cast<char>(kOnlyReturn);
  file_.write(record.data(), record.size());
  lowest_mm_ = lowest_mm_.cwiseMin(p_mm);
  highest_mm_ = highest_mm_.cwiseMax(p_mm);
  ++count_;
}

void LasWriter::close() {
  if (!file_.is_open()) return;
  file_.seek(0);
  file_.write(header());
  file_.close();
}

}  // namespace isobar::files
