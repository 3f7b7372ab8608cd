// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: configuration, manifest and names of floors. An accepted configuration must print as one that is accepted.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "run/floors/floor_names.hpp"
#include "run/recording/manifest.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const std::string shown = isobar::show_config(isobar::parse_config(text, "fuzz.toml"));
    if (isobar::show_config(isobar::parse_config(shown, "shown.toml")) != shown) {
      std::abort();
    }
  } catch (const isobar::ConfigError& error) {
    if (std::string_view(error.what()).starts_with("shown.toml")) {
      std::abort();
    }
  }
  try {
    std::vector<std::string> warnings;
    isobar::recording::parse_manifest(text, "fuzz.toml", warnings);
  } catch (const isobar::DataError&) {
    // the specified refusal
  }
  try {
    static_cast<void>(isobar::files::FloorNames::parse(std::string(text), "floors.toml"));
  } catch (const isobar::DataError&) {
    return 0;  // the same
  }
  return 0;
}
