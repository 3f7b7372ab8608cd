// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar::keys {

/// Highest DDS domain that DDS security (Cyclone's access control) knows; 232 is the highest without it.
inline constexpr int kLastDomain = 230;

}  // namespace isobar::keys
