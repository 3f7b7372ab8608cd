// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace isobar::test {

/// Number of calls of operator new since the test program started.
std::size_t allocation_count();

}  // namespace isobar::test
