// SPDX-License-Identifier: BSD-3-Clause
// A command line as data: what manual pages and completions show of a CLI::App.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace isobar::manual {

/// One option or positional argument.
struct Option {
  std::vector<std::string> names;  ///< "-h", "--help"; of a positional its name, "RECORDING"
  bool positional = false;
  std::string value;  ///< "FILE"; empty: takes none
  std::string purpose;
  std::string default_value;         ///< empty: none
  std::string rule;                  ///< "FLOAT in [0 - 1]"; empty: none, or `choices`
  std::vector<std::string> choices;  ///< the only values allowed; empty: any
  bool required = false;
};

/// A program or a subcommand.
struct Command {
  std::string name;         ///< with the commands above it, "isobar map export"
  std::string purpose;      ///< one line
  std::string description;  ///< lines after the first; may be empty
  std::vector<Option> options;
  std::vector<Command> commands;

  [[nodiscard]] std::string last_name() const;  ///< "export"
};

/// Reads a command line, without hidden options and commands.
Command command_tree(const CLI::App& app);

/// The command and all below it, parents first.
std::vector<const Command*> flattened(const Command& root);

/// Replaces each occurrence of `from`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Words with a separator between them.
std::string joined(const std::vector<std::string>& words, const std::string& separator);

}  // namespace isobar::manual
