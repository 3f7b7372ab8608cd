// SPDX-License-Identifier: BSD-3-Clause
// The one translation unit of toml++: its parser is compiled once, not in each file that reads TOML.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
