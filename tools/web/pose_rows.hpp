// SPDX-License-Identifier: BSD-3-Clause
// Poses as viewers get them, in bounded number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace isobar::web {

/// Pose of base_link in the map frame, and the height from air pressure. NaN: unknown.
struct PoseRow {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t stamp_ns = 0;
  double x_m = kUnknown, y_m = kUnknown, z_m = kUnknown, yaw_deg = kUnknown;
  double z_sd_m = kUnknown;
  double altimeter_m = kUnknown;
  double bias_m = kUnknown, bias_sd_m = kUnknown;
  bool registered = false;  ///< on a scan
};

/// A series of any length in bounded memory: when it is full, every other row goes, and from then on only every second
/// (fourth …) new one is taken.
template <typename Row>
class ThinnedRows {
 public:
  explicit ThinnedRows(std::size_t most) : most_(most) {}

  void add(const Row& row) {
    if (offered_++ % step_ != 0) return;
    if (rows_.size() >= most_) halve();
    rows_.push_back(row);
  }
  void clear() {
    rows_.clear();
    offered_ = 0;
    step_ = 1;
  }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  void halve() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows_.size(); i += 2) rows_[kept++] = std::move(rows_[i]);
    rows_.resize(kept);
    step_ *= 2;
  }

  std::size_t most_;
  std::size_t step_ = 1;
  std::uint64_t offered_ = 0;
  std::vector<Row> rows_;
};

}  // namespace isobar::web
