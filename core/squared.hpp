// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar {

constexpr double squared(double x) { return x * x; }

}  // namespace isobar
