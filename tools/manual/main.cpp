// SPDX-License-Identifier: BSD-3-Clause
// isobar_manual FOLDER VERSION: writes manual pages and completions of all programs, from the tables behind
// --help and from the settings table. Runs at build time and is not installed.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "daemon/bridge/settings.hpp"
#include "daemon/options.hpp"
#include "run/files/text_file.hpp"
#include "tools/isobar_app.hpp"
#include "tools/manual/completions.hpp"
#include "tools/manual/pages.hpp"

namespace isobar::manual {
namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  Writer(fs::path folder, std::string version) : folder_(std::move(folder)), version_(std::move(version)) {
    for (const char* name : {"man/man1", "man/man5", "man/man8", "bash", "zsh", "fish"}) {
      fs::create_directories(folder_ / name);
    }
  }

  void page(const Command& command, int section, const std::string& see_also) {
    Page page = command_page(command, section, version_);
    if (section == 8) add_service(command, page);
    page.heading("See also");
    page.paragraph(see_also);
    write(page, page_name(command), section);
  }
  void settings() {
    Page page = settings_page(version_);
    page.heading("Files");
    page.entry("/etc/isobar/isobar.toml", "configuration of the service");
    page.entry("/etc/isobar/conf.d/*.toml", "read after it, in the order of their names");
    page.heading("See also");
    page.paragraph("isobard(8), isobar-dds(8), isobar-config(1)");
    write(page, "isobar.toml", 5);
  }
  void completions(const Command& program) {
    files::write_text_file(folder_ / "bash" / program.name, bash_completion(program));
    files::write_text_file(folder_ / "zsh" / ("_" + program.name), zsh_completion(program));
    files::write_text_file(folder_ / "fish" / (program.name + ".fish"), fish_completion(program));
  }

 private:
  /// What only the services have: units and files.
  static void add_service(const Command& command, Page& page) {
    page.heading("Service");
    page.paragraph("Unit of systemd: `" + command.name + ".service`, as user isobar; `journalctl -u " +
                   command.name + "` shows its log, `systemctl reload " + command.name +
                   "` reads the configuration anew.");
    page.heading("Files");
    page.entry("/etc/isobar/isobar.toml", "configuration, see isobar.toml(5)");
    page.entry("/var/lib/isobar", "maps and trajectories");
    page.entry("/run/isobar", "shared memory of both services: their /dev/shm and /tmp");
  }

  void write(const Page& page, const std::string& name, int section) const {
    const std::string number = std::to_string(section);
    files::write_text_file(folder_ / "man" / ("man" + number) / (name + "." + number), page.text());
  }

  fs::path folder_;
  std::string version_;
};

void write_all(const fs::path& folder, const std::string& version) {
  Writer writer(folder, version);
  CLI::App isobar_app;
  tools::add_all_commands(isobar_app);
  const Command isobar = command_tree(isobar_app);
  writer.page(isobar, 1, "isobard(8), isobar-dds(8), isobar.toml(5)");
  for (const Command& command : isobar.commands)
    writer.page(command, 1, "isobar(1), isobard(8), isobar.toml(5)");
  writer.completions(isobar);

  CLI::App isobard_app;
  Options isobard_options;
  add_options(isobard_app, isobard_options);
  const Command isobard = command_tree(isobard_app);
  writer.page(isobard, 8, "isobar(1), isobar-dds(8), isobar.toml(5)");
  writer.completions(isobard);

  CLI::App bridge_app;
  bridge::Options bridge_options;
  bridge::add_options(bridge_app, bridge_options);
  const Command bridge = command_tree(bridge_app);
  writer.page(bridge, 8, "isobard(8), isobar(1), isobar.toml(5)");
  writer.completions(bridge);
  writer.settings();
}

}  // namespace
}  // namespace isobar::manual

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: isobar_manual FOLDER VERSION\n");
    return 64;
  }
  try {
    isobar::manual::write_all(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "isobar_manual: %s\n", error.what());
    return 70;
  }
}
