// SPDX-License-Identifier: BSD-3-Clause
// Start of the attitude: mean direction of the specific force over the first samples.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isobar {

/// Sums the specific force in the axes of the newest sample, so that a robot that turns meanwhile aligns,
/// too.
class GravityAlignment {
 public:
  enum class Status : std::uint8_t {
    kSumming,
    kAligned,       ///< force_sum() points up
    kWrongGravity,  ///< the mean force is not gravity's; the sum has been restarted
  };

  /// `duration_s`: length of the mean, > 0.
  explicit GravityAlignment(double duration_s) : duration_s_(duration_s) {}

  /// `turn_rad`: turn since the sample before, base axes.
  Status add(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& force_m_s2, double dt_s);
  [[nodiscard]] const Eigen::Vector3d& force_sum() const { return force_sum_; }
  void restart();

 private:
  double duration_s_;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  double elapsed_s_ = 0.0;
  int samples_ = 0;
};

}  // namespace isobar
