// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/completions.hpp"

namespace isobar::manual {
namespace {

/// A word of _describe: 'name:what it is', quoted for the shell.
std::string described(const std::string& name, const std::string& purpose) {
  return "'" + replaced(replaced(name, ":", "\\:"), "'", "'\\''") + ":" + replaced(purpose, "'", "'\\''") +
         "'";
}

std::string zsh_value_cases(const Command& command) {
  std::string text;
  for (const Option& option : command.options) {
    if (option.positional || option.value.empty()) continue;
    for (const std::string& name : option.names) {
      text += "    '" + command.name + " " + name + "') ";
      text += option.choices.empty() ? "_files" : "compadd -- " + joined(option.choices, " ");
      text += "; return ;;\n";
    }
  }
  return text;
}

std::string zsh_word_case(const Command& command) {
  std::string options;
  std::string words;
  for (const Option& option : command.options) {
    for (const std::string& choice : option.choices) {
      if (option.positional) words += " " + described(choice, "");
    }
    if (option.positional) continue;
    for (const std::string& name : option.names) options += " " + described(name, option.purpose);
  }
  for (const Command& below : command.commands) words += " " + described(below.last_name(), below.purpose);
  return "    '" + command.name + "')\n      options=(" + options + " )\n      names=(" + words + " ) ;;\n";
}

}  // namespace

std::string zsh_completion(const Command& program) {
  std::vector<std::string> paths;
  std::string values;
  std::string words;
  for (const Command* command : flattened(program)) {
    if (command != &program) paths.push_back("'" + command->name + "'");
    values += zsh_value_cases(*command);
    words += zsh_word_case(*command);
  }
  std::string text = "#compdef " + program.name + "\n";
  text += "# zsh completion of " + program.name + ", written at build time by isobar_manual\n";
  text += "local command='" + program.name + "' word\nlocal -a options names\n";
  text += "for word in ${words[2,CURRENT-1]}; do\n  case \"$command $word\" in\n";
  if (!paths.empty()) text += "    " + joined(paths, "|") + ") command+=\" $word\" ;;\n";
  text += "  esac\ndone\n";
  text += "case \"$command ${words[CURRENT-1]}\" in\n" + values + "esac\n";
  text += "case \"$command\" in\n" + words + "esac\n";
  text += "if [[ ${words[CURRENT]} == -* ]]; then\n  _describe option options\n";
  return text + "elif (( $#names )); then\n  _describe command names\nelse\n  _files\nfi\n";
}

}  // namespace isobar::manual
