// SPDX-License-Identifier: BSD-3-Clause
// Deskewing and downsampling of a scan in one pass.
#pragma once

#include "core/registration/deskew.hpp"
#include "core/registration/sampling.hpp"

namespace isobar {

/// Deskews `scan` and downsamples it into `out` and sampler.sample(). Works in parts of 8 kB that stay in the
/// L1 cache: dropped points are never written to `out`. The result is that of one single part, bit for bit.
void prepare_scan(const Scan& scan, const PriorHistory& history, const ScanMotion& motion, Deskewer& deskewer,
                  Sampler& sampler, RegisteredScan& out);

}  // namespace isobar
