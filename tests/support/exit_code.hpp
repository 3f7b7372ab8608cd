// SPDX-License-Identifier: BSD-3-Clause
// One subcommand of `isobar`, run inside the test. Without CLI11's header, which costs each file that includes it as much
// as the rest of the test.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace isobar::test {

/// Exit code of `isobar` with one subcommand: 0, the thrown error's, or 64 for a parse error.
/// @param add_command adds the subcommand to an app (tools/commands.hpp)
/// @param words the command line without the program's name
int exit_code(void (*add_command)(CLI::App&), const std::vector<std::string>& words);

}  // namespace isobar::test
