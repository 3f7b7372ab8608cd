// SPDX-License-Identifier: BSD-3-Clause
// Record of a registered scan on the disk: a head with the pose, and its points, thinned. Little-endian, with checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/estimates.hpp"

namespace isobar {

/// Points of a scan at most: every n-th of more.
inline constexpr std::uint32_t kMostScanPoints = 10'000;

/// Writes the record of a scan in place of `record`'s content: 104 bytes, and 8 a point.
void encode_scan(const RegisteredScan& scan, std::vector<std::byte>& record);

/// Takes the first record off `bytes`. The points are within half a unit, 1/32000 of the scan's reach, of those of the
/// scan.
/// @return false if it is cut or damaged; `bytes` and `scan` are then as before
bool decode_scan(std::span<const std::byte>& bytes, RegisteredScan& scan);

}  // namespace isobar
