// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <span>

namespace isobar::tools {

struct CommandExample {
  const char* command;  ///< "isobar map grid"
  const char* words;    ///< the example behind it: options and arguments
};

/// One for each command that does something by itself.
[[nodiscard]] std::span<const CommandExample> command_examples();

/// Ends the help of every command below `app` with its example, unless it has its own.
void add_examples(CLI::App& app);

}  // namespace isobar::tools
