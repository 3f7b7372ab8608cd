// SPDX-License-Identifier: BSD-3-Clause
// `isobar keys`: makes and lists the keys that sign base-station pressure.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "ipc/keys/certificate.hpp"
#include "ipc/keys/key_folder.hpp"
#include "ipc/keys/key_store.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

namespace fs = std::filesystem;

struct KeysOptions {
  fs::path store;
  keys::Member member;
  int years = 10;
};

void run_init(const KeysOptions& options) {
  keys::make_key_store(options.store, options.years);
  std::printf(
      "made: %s\nKeep this folder on one machine and a copy of it in a safe place: who has it can make keys. "
      "Next:\n  isobar keys add %s ROBOT\n  isobar keys add %s STATION --base-station NAME\n",
      options.store.c_str(), options.store.c_str(), options.store.c_str());
}

void run_add(const KeysOptions& options) {
  const std::string folder = keys::add_member(options.store, options.member, options.years).string();
  std::printf(
      "made: %s\nCopy it to the machine, there as root:\n"
      "  install -d -o isobar -g isobar -m 700 /etc/isobar/keys\n"
      "  install -o isobar -g isobar -m 600 %s/* /etc/isobar/keys\n"
      "and set in /etc/isobar/isobar.toml: dds.keys_directory = \"/etc/isobar/keys\"\n",
      folder.c_str(), options.member.name.c_str());
}

void run_revoke(const KeysOptions& options) {
  const keys::Revocation done = keys::revoke_member(options.store, options.member.name);
  std::printf(
      "revoked: %s; its folder is now %s\nMachines refuse it from 2 s after they have the new list. Copy %s "
      "to each, "
      "there as root:\n  install -o isobar -g isobar -m 600 revoked.pem /etc/isobar/keys\n",
      options.member.name.c_str(), done.moved.c_str(), done.list.c_str());
}

void run_show(const KeysOptions& options) {
  const std::int64_t now_s = keys::unix_now_s();
  std::string faults;
  for (const keys::StoreEntry& entry : keys::list_store(options.store)) {
    if (!entry.fault.empty()) {
      std::printf("%-20s unusable: %s\n", entry.name.c_str(), entry.fault.c_str());
      faults += (faults.empty() ? "" : ", ") + entry.name;
      continue;
    }
    constexpr std::int64_t kDayS = 86'400;
    std::printf("%-20s %-28s until %s (%lld days)\n", entry.name.c_str(), entry.use.c_str(),
                keys::date_of(entry.until_s).c_str(),
                static_cast<long long>((entry.until_s - now_s) / kDayS));
  }
  if (!faults.empty()) throw DataError(options.store.string() + ": unusable: " + faults);
}

void add_years(Subcommand<KeysOptions>& subcommand) {
  subcommand.command.add_option("--years", subcommand.options.years, "validity, from today")
      ->check(number_within(1, 50))
      ->capture_default_str();
}

}  // namespace

void add_keys_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("keys", "Make and list the keys that sign base-station pressure");
  command->require_subcommand(1);

  auto init = add_subcommand<KeysOptions>(
      *command, "init", "Make a folder with the two authorities that all keys of a site come from", run_init);
  init.command.add_option("DIR", init.options.store, "new folder")->required();
  init.options.years = 20;
  add_years(init);

  auto add = add_subcommand<KeysOptions>(
      *command, "add", "Make the keys of a robot or of a base station, in the new folder DIR/NAME", run_add);
  add.command.add_option("DIR", add.options.store, "folder of `isobar keys init`")->required();
  add.command.add_option("NAME", add.options.member.name, "name of the machine")->required();
  add.command
      .add_option(
          "--base-station", add.options.member.station,
          "the machine is a base station of this name, its dds.base_station, and writes its pressure; "
          "without: it is a robot and reads that of all")
      ->type_name("STATION");
  add_years(add);

  auto revoke = add_subcommand<KeysOptions>(
      *command, "revoke", "Revoke the keys of a machine that was stolen, sold or replaced", run_revoke);
  revoke.command.add_option("DIR", revoke.options.store, "folder of `isobar keys init`")->required();
  revoke.command.add_option("NAME", revoke.options.member.name, "name of the machine")->required();

  auto show =
      add_subcommand<KeysOptions>(*command, "show", "List names, uses and ends of validity", run_show);
  show.command.add_option("DIR", show.options.store, "folder of `isobar keys init`")->required();
}

}  // namespace isobar::tools
