// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/completions.hpp"

namespace isobar::manual {
namespace {

std::string quoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// "complete" with the condition that the words so far choose this command.
std::string rule(const std::string& program, const std::string& function, const Command& command) {
  return "complete -c " + program + " -n " + quoted("test (" + function + ") = \"" + command.name + "\"");
}

std::string option_rule(const std::string& begin, const Option& option) {
  std::string text = begin;
  for (const std::string& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.choices.empty()) {
    text += " -x -a " + quoted(joined(option.choices, " "));
  } else if (!option.value.empty()) {
    text += " -r";
  }
  return text + " -d " + quoted(option.purpose) + "\n";
}

}  // namespace

std::string fish_completion(const Command& program) {
  const std::string function = "__" + replaced(program.name, "-", "_") + "_command";
  std::vector<std::string> paths;
  std::string rules;
  for (const Command* command : flattened(program)) {
    if (command != &program) paths.push_back(quoted(command->name));
    const std::string begin = rule(program.name, function, *command);
    for (const Command& below : command->commands) {
      rules += begin + " -f -a " + below.last_name() + " -d " + quoted(below.purpose) + "\n";
    }
    for (const Option& option : command->options) {
      if (!option.positional) {
        rules += option_rule(begin, option);
      } else if (!option.choices.empty()) {
        rules += begin + " -f -a " + quoted(joined(option.choices, " ")) + "\n";
      }
    }
  }
  std::string text = "# fish completion of " + program.name + ", written at build time by isobar_manual\n";
  text += "function " + function + "\n  set -l command " + program.name + "\n";
  text += "  set -l words (commandline -opc)\n";
  text += "  for word in $words[2..-1]\n    switch \"$command $word\"\n";
  if (!paths.empty())
    text += "      case " + joined(paths, " ") + "\n        set command \"$command $word\"\n";
  return text + "    end\n  end\n  echo $command\nend\n" + rules;
}

}  // namespace isobar::manual
