// SPDX-License-Identifier: BSD-3-Clause
// The log of Cyclone DDS, which by itself goes to stderr.
#pragma once

#include <string_view>

namespace isobar::dds {

/// Directs the library's warnings and errors to `use`, called in any thread, one at a time.
/// @param use gets one line without its end; is_error is false for a warning
void set_library_log(void (*use)(bool is_error, std::string_view line) noexcept);

}  // namespace isobar::dds
