// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/errors.hpp"

namespace isobar::test {

/// Exit code of `isobar` with one subcommand: 0, the thrown error's, or 64 for a parse error.
template <typename AddCommand>
int exit_code(AddCommand add_command, std::vector<std::string> words) {
  CLI::App app;
  app.require_subcommand(1);
  add_command(app);
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError&) {
    return 64;
  } catch (const Error& error) {
    return error.exit_code();
  }
  return 0;
}

}  // namespace isobar::test
