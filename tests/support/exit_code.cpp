// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/exit_code.hpp"

#include <CLI/CLI.hpp>

#include "core/errors.hpp"

int isobar::test::exit_code(void (*add_command)(CLI::App&), const std::vector<std::string>& words) {
  CLI::App app;
  app.require_subcommand(1);
  add_command(app);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the words from the back
  } catch (const CLI::ParseError&) {
    return 64;
  } catch (const Error& error) {
    return error.exit_code();
  }
  return 0;
}
