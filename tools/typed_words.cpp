// SPDX-License-Identifier: BSD-3-Clause
#include "tools/typed_words.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "core/nearest_word.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

const CLI::App* command_named(const CLI::App& app, const std::string& name) {
  const auto found =
      app.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::string where_shown(const CLI::App& app) { return "; `" + command_path(app) + " --help` shows all"; }

bool has_arguments(const CLI::App& app) {
  const auto options = app.get_options();
  return std::any_of(options.begin(), options.end(),
                     [](const CLI::Option* option) { return option->get_positional(); });
}

/// The command that was typed: the deepest one that the parser has met.
const CLI::App& typed(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : typed(*commands.front());
}

void check_option(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(2, word.find('=') - 2);
  const std::vector<std::string> known = option_names(app);
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw UsageError("--" + name + ": " + command_path(app) + " has no such option" +
                   did_you_mean(name, known, "--") + where_shown(app));
}

}  // namespace

void check_typed_words(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  bool takes_commands = true;
  bool has_option = false;
  for (const std::string& word : words) {
    if (word == "--") return;
    if (word.size() > 2 && word.starts_with("--")) {
      check_option(*command, word);
      has_option = true;
    } else if (takes_commands && !word.starts_with('-')) {
      const CLI::App* next = command_named(*command, word);
      // Behind an option a word may be its value.
      const bool must_be_command =
          command->get_require_subcommand_min() > 0 ||
          (!has_option && !has_arguments(*command) && !command_names(*command).empty());
      if (next == nullptr && must_be_command) {
        throw UsageError(word + ": no such command" +
                         did_you_mean(word, command_names(*command), command_path(*command) + " ") +
                         where_shown(*command));
      }
      takes_commands = next != nullptr;
      if (next != nullptr) command = next;
    }
  }
}

std::string parse_problem(const CLI::App& app, const CLI::ParseError& error) {
  std::string text = error.what();
  // "Could not convert: NAME = WORD": of a number.
  const std::string prefix = "Could not convert: ";
  const std::size_t equals = text.find(" = ");
  if (text.starts_with(prefix) && equals != std::string::npos) {
    text = text.substr(prefix.size(), equals - prefix.size()) + ": \"" + text.substr(equals + 3) +
           "\" is no number that it takes";
  }
  return text + "; `" + command_path(typed(app)) + " --help` explains it";
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  const auto check = [words, all](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return {};
    return "\"" + word + "\" is none of " + all + did_you_mean(word, words);
  };
  // As CLI11's own sets are shown: manual pages and completions read the choices here.
  std::string set;
  for (const std::string& word : words) set += (set.empty() ? "" : ",") + word;
  return {check, "{" + set + "}", ""};
}

}  // namespace isobar::tools
