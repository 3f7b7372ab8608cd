// SPDX-License-Identifier: BSD-3-Clause
// The one way to declare a subcommand of `isobar`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace isobar::tools {

/// A subcommand under declaration and the variables that its options set.
template <typename Options>
struct Subcommand {
  CLI::App& command;
  Options& options;
};

/// "isobar experiment sensitivity": the names of the command and those above it.
std::string command_path(const CLI::App& command);

/// The parsed command line as a shell takes it, with all options that were given: for reports.
std::string typed_command(const CLI::App& command);

/// Adds a subcommand with its own `Options`, which live as long as the parser. After parsing it calls
/// `run(options)`, or `run(options, typed_command)` for reports that name the command, unless one of the
/// subcommand's own subcommands was chosen.
template <typename Options, typename Run>
Subcommand<Options> add_subcommand(CLI::App& parent, const std::string& name, const std::string& purpose,
                                   Run run) {
  auto options = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(name, purpose);
  command->callback([options, command, run] {
    if (!command->get_subcommands().empty()) return;
    if constexpr (std::is_invocable_v<Run, const Options&, const std::string&>) {
      run(*options, typed_command(*command));
    } else {
      run(*options);
    }
  });
  return {*command, *options};
}

/// The words between commas; none of an empty text.
std::vector<std::string> comma_separated(const std::string& text);

/// Writes a file and prints its name.
/// @throws ServiceError naming the file when it cannot be written
void write_output(const std::filesystem::path& file, std::string_view text);

}  // namespace isobar::tools
