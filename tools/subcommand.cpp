// SPDX-License-Identifier: BSD-3-Clause
#include "tools/subcommand.hpp"

#include <cstdio>
#include <sstream>

#include "run/files/text_file.hpp"

namespace isobar::tools {

namespace {

/// A word in single quotes where the shell would otherwise change it.
std::string shell_quoted(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t'\"\\$&;|<>()*?") == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string command_path(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? "isobar" : command_path(*parent) + " " + command.get_name();
}

std::string typed_command(const CLI::App& command) {
  std::string text = command_path(command);
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_lnames().empty() ? "" : " --" + option->get_lnames().front();
    const bool is_flag = option->get_expected_max() == 0;
    // A list either follows its option once, or repeats the option before each word.
    const bool repeats = option->get_expected_max() > 1 && !option->get_allow_extra_args();
    if (is_flag || !repeats) text += name;
    if (is_flag) continue;
    for (const std::string& word : option->results()) {
      text += (repeats ? name : "") + " " + shell_quoted(word);
    }
  }
  return text;
}

std::vector<std::string> comma_separated(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

void write_output(const std::filesystem::path& file, std::string_view text) {
  files::write_text_file(file, text);
  std::printf("written: %s\n", file.c_str());
}

}  // namespace isobar::tools
