// SPDX-License-Identifier: BSD-3-Clause
// Foreign recordings to a recording folder.
#pragma once

#include <filesystem>
#include <functional>

#include "tools/import/request.hpp"

namespace isobar::tools {

/// Whether `source` is a recording folder.
[[nodiscard]] bool is_recording(const std::filesystem::path& source);

/// Whether `source` is something that import_source() may read; a recording folder is not.
[[nodiscard]] bool is_importable(const std::filesystem::path& source);

/// Imports a source into request.out, which must not exist or be empty. After a failure it is as it was before.
/// @param progress called with 0 … 1
/// @throws UsageError with the option that a person must give; DataError for what cannot be read or written
ImportReport import_source(const ImportRequest& request, const std::function<void(double)>& progress);

}  // namespace isobar::tools
