// SPDX-License-Identifier: BSD-3-Clause
// The command line of isobard, for the program and for its manual page.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace isobar {

/// The command line of isobard.
struct Options {
  std::string config_file;       ///< empty: defaults
  std::string output_directory;  ///< empty: the configuration's
};

/// Adds description, version and options of isobard to its command line; parsing fills `options`.
void add_options(CLI::App& app, Options& options);

}  // namespace isobar
