// SPDX-License-Identifier: BSD-3-Clause
// From a scan as it was measured to the points that are worth registering, in one pass over it.
#pragma once

#include "core/registration/deskew.hpp"
#include "core/registration/sampling.hpp"

namespace isobar {

/// Deskewer::deskew() and then Sampler::thin(), to the bit, but in parts that stay in the processor's first
/// cache: what is not kept is never written to `out`.
void prepare_scan(const Scan& scan, const PriorHistory& history, const ScanMotion& motion, Deskewer& deskewer,
                  Sampler& sampler, RegisteredScan& out);

}  // namespace isobar
