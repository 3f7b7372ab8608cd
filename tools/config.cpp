// SPDX-License-Identifier: BSD-3-Clause
// `isobar config`: checks a configuration, shows all settings.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "config/config_io.hpp"
#include "tools/commands.hpp"

namespace isobar::tools {

void add_config_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("config", "Check a configuration or show all settings");
  command->require_subcommand(1);
  const auto file = std::make_shared<std::string>();

  CLI::App* check = command->add_subcommand("check", "Check a file: keys, types, units, ranges");
  check->add_option("FILE", *file, "configuration in TOML")->required();
  check->callback([file] {
    load_config(*file);
    std::printf("%s: all right\n", file->c_str());
  });

  CLI::App* show =
      command->add_subcommand("show", "Print every setting with unit, range and reason, as TOML");
  show->add_option("FILE", *file, "configuration whose values take the place of the defaults");
  show->callback([file] {
    const std::string text = show_config(file->empty() ? Config{} : load_config(*file));
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

}  // namespace isobar::tools
