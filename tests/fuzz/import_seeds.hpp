// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace isobar::test {

/// Seeds of fuzz_import.
void write_import_seeds(const std::filesystem::path& root);

}  // namespace isobar::test
