// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/samples.hpp"
#include "drivers/lidar/turn_directions.hpp"
#include "drivers/ouster/metadata.hpp"

namespace isobar::ouster {

/// From range, row and measurement id to a point in the sensor's frame: Ouster sensor documentation, "Lidar Range
/// to XYZ". The beam of a row starts beside the axis of rotation and turns with it:
///
///     p_lidar = Rz(theta) ((r - n) u_row + b),   theta = 2 pi (1 - id / columns)
///
/// with the beams' origin b in the turning frame, n = |b|, the range r from the axis, and the beam's direction u_row
/// from its azimuth (clockwise) and altitude. p_sensor = T_sensor_lidar p_lidar.
class BeamGeometry {
 public:
  struct Column {
    std::array<float, 9> rotation;  // row-major: turning frame to sensor frame
    std::array<float, 3> origin_m;  // of the beams
  };
  struct Beam {
    std::array<float, 3> direction;  // in the turning frame
    std::uint32_t ahead;             // azimuth in the sensor's frame, clockwise, at id 0 [0.01 deg]
    std::uint8_t ring;               // 0 is the lowest
  };

  explicit BeamGeometry(const Metadata& metadata);

  [[nodiscard]] const Column& column(std::uint32_t measurement_id) const { return columns_[measurement_id]; }
  /// By row, the highest first.
  [[nodiscard]] const std::vector<Beam>& beams() const { return beams_; }
  /// Position in the turn [0.01 deg].
  [[nodiscard]] std::uint32_t turn(std::uint32_t measurement_id) const {
    return measurement_id * kFullTurn / static_cast<std::uint32_t>(columns_.size());
  }

  /// The point at a range [m]; without time and intensity.
  [[nodiscard]] ScanPoint point(const Column& column, const Beam& beam, float range_m) const {
    const float along_m = range_m - origin_distance_m_;
    const float u = beam.direction[0] * along_m;
    const float v = beam.direction[1] * along_m;
    const float w = beam.direction[2] * along_m;
    const auto& R = column.rotation;
    return {R[0] * u + R[1] * v + R[2] * w + column.origin_m[0],
            R[3] * u + R[4] * v + R[5] * w + column.origin_m[1],
            R[6] * u + R[7] * v + R[8] * w + column.origin_m[2],
            0,
            beam.ring,
            0};
  }

 private:
  std::vector<Column> columns_;
  std::vector<Beam> beams_;
  float origin_distance_m_ = 0.0F;
};

}  // namespace isobar::ouster
