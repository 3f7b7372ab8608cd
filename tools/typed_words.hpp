// SPDX-License-Identifier: BSD-3-Clause
// Words of a command line that no parser knows: named, with the word that was probably meant.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace isobar::tools {

/// Finds the first word that is neither a command where one is needed nor an option of the command before it.
/// @param words command line without the program's name
/// @throws UsageError naming the word, the nearest known one and where all are shown
void check_typed_words(const CLI::App& app, const std::vector<std::string>& words);

/// What the parser refused as one line that ends with the command whose help explains it.
[[nodiscard]] std::string parse_problem(const CLI::App& app, const CLI::ParseError& error);

/// One of the words, with a suggestion for a typing error.
CLI::Validator one_of(const std::vector<std::string>& words);

}  // namespace isobar::tools
