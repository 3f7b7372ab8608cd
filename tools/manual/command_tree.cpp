// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <sstream>

namespace isobar::manual {
namespace {

/// Splits CLI11's type, "TEXT:{a,b}" or "FLOAT:FLOAT in [0 - 1]", into value, choices and rule.
void read_type(const std::string& type, Option& option) {
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string rule = type.substr(colon + 1);
  if (!rule.starts_with('{') || !rule.ends_with('}')) {
    option.rule = rule;
    return;
  }
  std::istringstream words(rule.substr(1, rule.size() - 2));
  for (std::string word; std::getline(words, word, ',');) option.choices.push_back(word);
}

Option read_option(const CLI::Option& source) {
  Option option;
  option.positional = source.nonpositional() == false;
  if (option.positional) option.names = {source.get_name(true, false)};
  for (const std::string& name : source.get_snames()) option.names.push_back("-" + name);
  for (const std::string& name : source.get_lnames()) option.names.push_back("--" + name);
  option.purpose = source.get_description();
  option.required = source.get_required();
  const bool is_flag = source.get_expected_max() == 0;
  if (is_flag) return option;
  option.default_value = source.get_default_str();
  read_type(source.get_type_name(), option);
  return option;
}

Command read_command(const CLI::App& app, const std::string& path) {
  Command command;
  command.name = path + app.get_name();
  const std::string text = app.get_description();
  const std::size_t end = text.find('\n');
  command.purpose = text.substr(0, end);
  if (end != std::string::npos) command.description = text.substr(end + 1);
  // "isobard: pose of a robot": programs repeat their name, which the page already says.
  const std::size_t colon = command.purpose.find(": ");
  if (path.empty() && colon != std::string::npos) command.purpose.erase(0, colon + 2);
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) command.options.push_back(read_option(*option));
  }
  for (const CLI::App* below : app.get_subcommands(nullptr)) {
    if (!below->get_group().empty()) command.commands.push_back(read_command(*below, command.name + " "));
  }
  return command;
}

}  // namespace

std::string Command::last_name() const { return name.substr(name.rfind(' ') + 1); }

Command command_tree(const CLI::App& app) { return read_command(app, ""); }

std::vector<const Command*> flattened(const Command& root) {
  std::vector<const Command*> all{&root};
  for (const Command& command : root.commands) {
    for (const Command* below : flattened(command)) all.push_back(below);
  }
  return all;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace isobar::manual
