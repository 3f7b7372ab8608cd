// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "tools/import/request.hpp"

namespace isobar::tools {

/// Adds the options that answer what an import asks: for `isobar import` and `isobar replay`.
void add_import_options(CLI::App& command, ImportRequest& request);

/// Imports with a progress bar and prints the table and the notes.
void import_and_print(const ImportRequest& request);

}  // namespace isobar::tools
