// SPDX-License-Identifier: BSD-3-Clause
// The manual pages of Isobar.
#pragma once

#include <string>

#include "tools/manual/command_tree.hpp"
#include "tools/manual/roff.hpp"

namespace isobar::manual {

/// "isobar-map": name of the page of a command.
std::string page_name(const Command& command);

/// Name, synopsis, description and options of a program or subcommand, and all commands below a subcommand. A
/// program's page lists its subcommands and names their pages.
Page command_page(const Command& command, int section, const std::string& version);

/// isobar.toml(5): all settings with rule, default, reason and when a change takes effect.
Page settings_page(const std::string& version);

}  // namespace isobar::manual
