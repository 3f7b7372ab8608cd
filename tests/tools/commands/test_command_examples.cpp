// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <string>

#include "tools/command_examples.hpp"
#include "tools/isobar_app.hpp"
#include "tools/subcommand.hpp"
#include "tools/typed_words.hpp"

namespace isobar::test::test_command_examples {

using namespace isobar::tools;

namespace {

/// The parser has taken the whole command line.
struct Taken {};

void for_each_command(CLI::App& app, const std::function<void(CLI::App&)>& call) {
  call(app);
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    for_each_command(*command, call);
}

}  // namespace

TEST_CASE("the help of every command that does something ends with an example") {
  CLI::App app;
  add_all_commands(app);
  for_each_command(app, [](CLI::App& command) {
    if (command.get_require_subcommand_min() > 0) return;
    const std::string path = command_path(command);
    CHECK_MESSAGE(command.get_footer().find("\n  " + path) != std::string::npos, path);
  });
}

TEST_CASE("every example is a command line that its command takes") {
  for (const CommandExample& example : command_examples()) {
    CLI::App app;
    add_all_commands(app);
    bool is_there = false;  // some are only in an isobar with DDS
    for_each_command(app, [&](CLI::App& command) {
      command.parse_complete_callback([] { throw Taken(); });  // after all checks, before it runs
      is_there = is_there || command_path(command) == example.command;
    });
    if (!is_there) continue;
    const std::string line = example.command + std::string(" ") + example.words;
    CAPTURE(line);
    CHECK_THROWS_AS(app.parse(line, true), Taken);
  }
}

}  // namespace isobar::test::test_command_examples
