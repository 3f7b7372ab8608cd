// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration/scan_preparation.hpp"

#include <algorithm>
#include <array>

namespace isobar {

void prepare_scan(const Scan& scan, const PriorHistory& history, const ScanMotion& motion, Deskewer& deskewer,
                  Sampler& sampler, RegisteredScan& out) {
  constexpr std::size_t kPart = 512;  // 8 kB
  std::array<ScanPoint, kPart> moved;
  deskewer.start(scan, history, motion);
  sampler.start(out);
  const std::span<const ScanPoint> points(scan.points, std::min(scan.point_count, Scan::kMaxPoints));
  for (std::size_t done = 0; done < points.size(); done += kPart) {
    const std::size_t kept =
        deskewer.move(points.subspan(done, std::min(kPart, points.size() - done)), moved.data());
    sampler.add({moved.data(), kept}, out);
  }
  sampler.finish(out);
}

}  // namespace isobar
