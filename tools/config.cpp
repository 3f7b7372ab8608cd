// SPDX-License-Identifier: BSD-3-Clause
// `isobar config`: checks a configuration, prints the settings, proposes a file.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/config_layer.hpp"
#include "config/end_mark.hpp"
#include "config/problems.hpp"
#include "config/setting.hpp"
#include "core/errors.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/manifest.hpp"
#include "run/text/small_file.hpp"
#include "tools/commands.hpp"
#include "tools/config_proposal.hpp"
#include "tools/machine_survey.hpp"
#include "tools/number_option.hpp"
#include "tools/typed_words.hpp"

namespace isobar::tools {
namespace {

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());
}

/// Lists every error of a configuration, or says that there is none.
void check(const std::string& file) {
  try {
    const LoadedConfig loaded = load_layers(file);
    print_notes(loaded.notes);
    for (const std::string& name : loaded.files) std::printf("%s: all right\n", name.c_str());
    std::printf("hash %s\n", config_hash(loaded.config).c_str());
  } catch (const ConfigErrors& errors) {
    if (errors.all().size() == 1) throw;
    for (const std::string& problem : errors.all()) std::fprintf(stderr, "%s\n", problem.c_str());
    throw ConfigError(std::to_string(errors.all().size()) + " errors, listed above");
  }
}

void add_check(CLI::App& command) {
  CLI::App* check_command = command.add_subcommand(
      "check", "List all errors of a file and of conf.d/*.toml beside it: keys, types, ranges");
  const auto file = std::make_shared<std::string>(kInstalledConfig);
  check_command->add_option("FILE", *file, "configuration in TOML")->capture_default_str();
  check_command->callback([file] { check(*file); });
}

void add_seal(CLI::App& command) {
  CLI::App* seal = command.add_subcommand(
      "seal", "Print a file with a checksum as its last line; isobard refuses it when it arrives cut");
  const auto file = std::make_shared<std::string>();
  seal->add_option("FILE", *file, "configuration in TOML")->required();
  seal->callback([file] {
    const text::SmallFile read = text::read_small_file(*file, text::kMostConfigBytes);
    if (!read.refusal.empty()) throw ConfigError(*file + ": " + read.refusal);
    print(with_checksum(read.content));
  });
}

/// What `isobar config init` is asked for.
struct InitOptions {
  std::string file;
  std::string root = "/";
  double listen_s = 2.0;
};

/// Writes a new file; an existing one stays.
void write_new(const std::string& file, const std::string& text) {
  std::FILE* out = std::fopen(file.c_str(), "wxe");
  if (out == nullptr) {
    throw ServiceError(file + (errno == EEXIST
                                   ? ": exists; `isobar config init` overwrites nothing"
                                   : std::string(": cannot be written: ") + std::strerror(errno)));
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (std::fclose(out) != 0 || !written) throw ServiceError(file + ": cannot be written");
}

void add_init(CLI::App& command) {
  CLI::App* init = command.add_subcommand(
      "init",
      "Look at this machine (I2C, kernel drivers, serial lines, lidars that send) and propose a file");
  const auto options = std::make_shared<InitOptions>();
  init->add_option("FILE", options->file, "new file to write; without it the proposal is printed");
  init->add_option("--listen", options->listen_s, "time to listen for lidars [s]")
      ->check(number_within(0.0, 60.0))
      ->capture_default_str();
  init->add_option("--root", options->root, "folder with dev and sys, to look at another machine's")
      ->capture_default_str();
  init->callback([options] {
    Survey survey;
    survey_devices(options->root, survey);
    if (options->listen_s > 0.0) survey_lidars(options->listen_s, survey);
    const std::string text = proposal(survey);
    if (options->file.empty()) {
      print(text);
    } else {
      write_new(options->file, text);
      std::printf("%s: written; check the mounts\n", options->file.c_str());
    }
  });
}

/// What `isobar config show` is asked for.
struct ShowOptions {
  std::string file;
  std::string role;
  std::string recording;
  bool basic = false;
};

std::string shown_text(const ShowOptions& options) {
  const Shown shown = options.basic ? Shown::kBasic : Shown::kAll;
  LoadedConfig loaded;
  if (!options.file.empty()) loaded = load_layers(options.file);
  Config& config = loaded.config;
  if (options.role == role_choices().back()) config.role = Role::kBaseStation;
  if (!options.recording.empty()) {
    std::vector<std::string> warnings;
    config = with_sensors_of(recording::read_manifest(options.recording, warnings), config);
    print_notes(warnings);
    return show_config(config, shown);
  }
  return options.file.empty() ? show_config(config, shown) : show_config(loaded, shown);
}

void add_show(CLI::App& command) {
  CLI::App* show = command.add_subcommand(
      "show", "Print the settings with unit, range and reason as TOML, basic ones first");
  const auto options = std::make_shared<ShowOptions>();
  show->add_option("FILE", options->file,
                   "configuration whose values replace the defaults; each value then names its file");
  show->add_flag("--basic", options->basic, "print only the basic settings, those to set first on a robot");
  show->add_option("--role", options->role, "print the defaults of this role")
      ->check(one_of(role_choices()))
      ->excludes("FILE");
  show->add_option("--sensors-of", options->recording,
                   "recording whose sensors and mounts replace the defaults");
  show->callback([options] { print(shown_text(*options)); });
}

}  // namespace

void add_config_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("config", "Check a configuration, print the settings, propose a file");
  command->require_subcommand(1);
  add_check(*command);
  add_show(*command);
  add_seal(*command);
  add_init(*command);
}

}  // namespace isobar::tools
