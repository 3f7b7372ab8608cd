// SPDX-License-Identifier: BSD-3-Clause
// `isobar config`: checks a configuration, prints the settings.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/manifest.hpp"
#include "tools/commands.hpp"

namespace isobar::tools {

void add_config_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("config", "Check a configuration or print the settings");
  command->require_subcommand(1);
  const auto file = std::make_shared<std::string>();

  CLI::App* check = command->add_subcommand("check", "Check a file: keys, types, ranges");
  check->add_option("FILE", *file, "configuration in TOML")->required();
  check->callback([file] {
    load_config(*file);
    std::printf("%s: all right\n", file->c_str());
  });

  CLI::App* show = command->add_subcommand(
      "show", "Print the settings with unit, range and reason as TOML, basic ones first");
  show->add_option("FILE", *file, "configuration whose values replace the defaults");
  const auto basic = std::make_shared<bool>(false);
  show->add_flag("--basic", *basic, "print only the basic settings, those to set first on a robot");
  const auto role = std::make_shared<std::string>();
  show->add_option("--role", *role, "print the defaults of this role")
      ->check(CLI::IsMember(role_choices()))
      ->excludes("FILE");
  const auto recording = std::make_shared<std::string>();
  show->add_option("--sensors-of", *recording, "recording whose sensors and mounts replace the defaults");
  show->callback([file, basic, role, recording] {
    Config config = file->empty() ? Config{} : load_config(*file);
    if (*role == role_choices().back()) config.role = Role::kBaseStation;
    if (!recording->empty()) {
      std::vector<std::string> warnings;
      config = with_sensors_of(recording::read_manifest(*recording, warnings), config);
      for (const std::string& warning : warnings) std::fprintf(stderr, "note: %s\n", warning.c_str());
    }
    const std::string text = show_config(config, *basic ? Shown::kBasic : Shown::kAll);
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

}  // namespace isobar::tools
