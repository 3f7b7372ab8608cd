// SPDX-License-Identifier: BSD-3-Clause
// The command line of `isobar`, for the program and for its manual pages.
#pragma once

namespace CLI {
class App;
}

namespace isobar::tools {

/// Adds description, version and all subcommands.
void add_all_commands(CLI::App& app);

}  // namespace isobar::tools
