// SPDX-License-Identifier: BSD-3-Clause
// Checks of names of files, before any work is done for them.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::tools {

/// A file in a folder that is there, whose name ends with one of `endings` (".html"), in any case of letters: the
/// content has this format whatever the name says.
CLI::Validator written_as(const std::vector<std::string>& endings);

/// FOLDER.ending beside the folder: where its product goes unless another file is named.
std::filesystem::path beside(const std::filesystem::path& folder, const std::string& ending);

/// @param expected what should be there, "a recording with reference.tum"
/// @throws DataError naming the path and what was expected, when nothing is there
void require_path(const std::filesystem::path& path, const std::string& expected);

}  // namespace isobar::tools
