// SPDX-License-Identifier: BSD-3-Clause
// Counts what this test program allocates.
#pragma once

#include <cstddef>

namespace isobar::test {

/// Calls of operator new since the program began.
std::size_t allocation_count();

}  // namespace isobar::test
