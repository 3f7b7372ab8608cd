// SPDX-License-Identifier: BSD-3-Clause
// Checks of options that name a file to write, before any work is done for it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::tools {

/// A file whose name ends with one of `endings` (".html"), in any case of letters: the content has this format
/// whatever the name says.
CLI::Validator written_as(const std::vector<std::string>& endings);

/// FOLDER.ending beside the folder: where its product goes unless another file is named.
std::filesystem::path beside(const std::filesystem::path& folder, const std::string& ending);

}  // namespace isobar::tools
