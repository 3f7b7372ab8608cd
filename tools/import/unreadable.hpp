// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace isobar::tools {

/// Why a source is neither a recording nor anything that is imported, by what it holds: "FILE: is empty", "FILE: is a zip
/// archive; unpack it first" …
[[nodiscard]] std::string why_unreadable(const std::filesystem::path& source);

}  // namespace isobar::tools
