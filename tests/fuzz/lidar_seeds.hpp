// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace isobar::test {

/// Seeds of fuzz_ouster, fuzz_ouster_metadata and fuzz_livox.
void write_lidar_seeds(const std::filesystem::path& root);

}  // namespace isobar::test
