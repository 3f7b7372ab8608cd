// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace isobar::report {

using Cells = std::vector<std::string>;

/// A table for the terminal, one line per row: first column left-aligned, the others right-aligned.
std::string aligned_rows(const std::vector<Cells>& rows);

}  // namespace isobar::report
