// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/velodyne/decoder.hpp"

namespace isobar::test {

struct VelodyneConfig : LidarLimits {
  velodyne::Model model = velodyne::Model::kVlp16;
};

/// Scans of a Velodyne.
struct VelodyneStream : ScanAssembler {
  explicit VelodyneStream(const VelodyneConfig& config = {})
      : ScanAssembler(std::make_unique<velodyne::Decoder>(velodyne::traits_of(config.model), config)) {}
};

}  // namespace isobar::test
