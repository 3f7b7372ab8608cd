// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/bounded_toml.hpp"

#include "core/printable_text.hpp"
#include "run/text/toml_bounds.hpp"

namespace isobar::text {

toml::table parse_bounded_toml(std::string_view text, const std::string& file) {
  if (const auto fault = toml_fault(text)) throw TomlError(fault->line, fault->column, fault->rule);
  constexpr std::size_t kMostDescription = 200;  // the parser quotes keys of any length
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw TomlError(error.source().begin.line, error.source().begin.column,
                    "is no TOML: " + printable(error.description(), kMostDescription));
  }
}

}  // namespace isobar::text
