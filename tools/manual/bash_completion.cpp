// SPDX-License-Identifier: BSD-3-Clause
#include "tools/manual/completions.hpp"

namespace isobar::manual {
namespace {

/// Words that may follow a command where no option was begun: its subcommands and choices of its arguments.
std::vector<std::string> words_after(const Command& command) {
  std::vector<std::string> words;
  for (const Command& below : command.commands) words.push_back(below.last_name());
  for (const Option& option : command.options) {
    if (option.positional) words.insert(words.end(), option.choices.begin(), option.choices.end());
  }
  return words;
}

/// Cases of options with a value: its choices, or file names where the list is empty.
std::string bash_value_cases(const Command& command) {
  std::string text;
  for (const Option& option : command.options) {
    if (option.positional || option.value.empty()) continue;
    for (const std::string& name : option.names) {
      text += "    \"" + command.name + " " + name + "\") words=\"" + joined(option.choices, " ") + "\" ;;\n";
    }
  }
  return text;
}

std::string bash_word_case(const Command& command) {
  std::vector<std::string> names;
  for (const Option& option : command.options) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return "        \"" + command.name + "\") options=\"" + joined(names, " ") + "\"; words=\"" +
         joined(words_after(command), " ") + "\" ;;\n";
}

}  // namespace

std::string bash_completion(const Command& program) {
  const std::vector<const Command*> all = flattened(program);
  std::vector<std::string> paths;
  std::string values;
  std::string words;
  for (const Command* command : all) {
    if (command != &program) paths.push_back("\"" + command->name + "\"");
    values += bash_value_cases(*command);
    words += bash_word_case(*command);
  }
  const std::string function = "_" + replaced(program.name, "-", "_");
  std::string text = "# bash completion of " + program.name + ", written at build time by isobar_manual\n";
  text += function + "() {\n";
  text += "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n";
  text += "  local command=\"" + program.name + "\" options= words= i\n";
  text += "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case \"$command ${COMP_WORDS[i]}\" in\n";
  if (!paths.empty()) text += "      " + joined(paths, "|") + ") command+=\" ${COMP_WORDS[i]}\" ;;\n";
  text += "    esac\n  done\n";
  text += "  case \"$command $prev\" in\n" + values;
  text += "    *)\n      case \"$command\" in\n" + words + "      esac\n";
  text += "      [[ $cur == -* ]] && words=$options ;;\n  esac\n";
  text += "  COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n}\n";
  return text + "complete -o default -F " + function + " " + program.name + "\n";
}

}  // namespace isobar::manual
