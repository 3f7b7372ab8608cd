// SPDX-License-Identifier: BSD-3-Clause
// Checks of options that take a number: a message of one short line, where CLI11 prints the largest double in full.
#pragma once

#include <CLI/CLI.hpp>

namespace isobar::tools {

/// A number within lowest … highest.
CLI::Validator number_within(double lowest, double highest);

/// A number above 0.
CLI::Validator number_above_zero();

/// A number of at least 0.
CLI::Validator number_from_zero();

}  // namespace isobar::tools
