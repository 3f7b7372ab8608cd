// SPDX-License-Identifier: BSD-3-Clause
// The command line again, for reports: what a person would type.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace isobar::tools {

/// A word as a shell takes it: in quotation marks where it must be.
inline std::string shell_quoted(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t'\"\\$&;|<>()*?") == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// A parsed subcommand with all options that were given.
inline std::string typed_command(const CLI::App& command) {
  std::string text = "isobar " + command.get_name();
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    if (!option->get_lnames().empty()) text += " --" + option->get_lnames().front();
    if (option->get_expected_max() == 0) continue;
    for (const std::string& word : option->results()) text += " " + shell_quoted(word);
  }
  return text;
}

}  // namespace isobar::tools
