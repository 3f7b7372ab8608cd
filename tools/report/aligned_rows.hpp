// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace isobar::report {

/// The cells of one row.
using Cells = std::vector<std::string>;

/// A table for the terminal, a line a row: the first column stands left, the others right.
std::string aligned_rows(const std::vector<Cells>& rows);

}  // namespace isobar::report
