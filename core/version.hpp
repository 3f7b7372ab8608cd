// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace isobar {

/// Version and git commit of this build, "0.1.0 (2539df3)"; "+" after the commit: built from changed files. The
/// version alone when built outside a git repository.
[[nodiscard]] std::string_view version();

/// What `PROGRAM --version` prints, "isobard 0.1.0 (2539df3)".
[[nodiscard]] inline std::string version_line(std::string_view program) {
  return std::string(program) + " " + std::string(version());
}

}  // namespace isobar
