// SPDX-License-Identifier: BSD-3-Clause
// Completion of command lines in shells: subcommands, options, and the values of those that have a list of them;
// file names everywhere else.
#pragma once

#include <string>

#include "tools/manual/command_tree.hpp"

namespace isobar::manual {

std::string bash_completion(const Command& program);
std::string zsh_completion(const Command& program);
std::string fish_completion(const Command& program);

}  // namespace isobar::manual
