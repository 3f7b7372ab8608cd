// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/pages.hpp"

namespace isobar::manual {
namespace {

bool is_program(const Command& command) { return command.name.find(' ') == std::string::npos; }

/// "--config FILE", "RECORDING".
std::string term(const Option& option) {
  const std::string names = joined(option.names, ", ");
  return option.positional || option.value.empty() ? names : names + " " + option.value;
}

/// "Purpose. One of a, b. Default: a."
std::string explanation(const Option& option) {
  std::string text = option.purpose;
  const auto add = [&text](const std::string& sentence) {
    if (!text.empty() && text.back() != '.') text += '.';
    text += (text.empty() ? "" : " ") + sentence;
  };
  if (!option.choices.empty()) add("One of " + joined(option.choices, ", ") + ".");
  if (!option.rule.empty()) add("Rule: " + option.rule + ".");
  if (!option.default_value.empty()) add("Default: " + option.default_value + ".");
  if (option.required && !option.positional) add("Required.");
  return text;
}

/// "isobar play [OPTIONS] RECORDING".
std::string synopsis(const Command& command) {
  std::string text = command.name + " [OPTIONS]";
  for (const Option& option : command.options) {
    if (option.positional) text += option.required ? " " + option.names[0] : " [" + option.names[0] + "]";
  }
  return command.commands.empty() ? text : text + " COMMAND";
}

void add_option_entries(const Command& command, Page& page) {
  for (const Option& option : command.options) page.entry(term(option), explanation(option));
}

/// A subcommand of a subcommand, in its parent's page, and all below it.
void add_nested(const Command& command, Page& page) {
  page.heading(command.name);
  page.paragraph(command.purpose + (command.purpose.ends_with('.') ? "" : "."));
  page.lines(synopsis(command));
  add_option_entries(command, page);
  for (const Command& below : command.commands) add_nested(below, page);
}

void add_commands(const Command& command, Page& page) {
  if (command.commands.empty()) return;
  if (!is_program(command)) {
    for (const Command& below : command.commands) add_nested(below, page);
    return;
  }
  page.heading("Commands");
  for (const Command& below : command.commands) page.entry(page_name(below) + "(1)", below.purpose);
}

}  // namespace

std::string page_name(const Command& command) { return replaced(command.name, " ", "-"); }

Page command_page(const Command& command, int section, const std::string& version) {
  Page page(page_name(command), section, version, command.purpose);
  page.heading("Synopsis");
  page.lines(synopsis(command));
  page.heading("Description");
  page.paragraph(command.purpose + (command.purpose.ends_with('.') ? "" : "."));
  if (!command.description.empty()) page.lines(command.description);
  page.heading("Options");
  add_option_entries(command, page);
  add_commands(command, page);
  return page;
}

}  // namespace isobar::manual
