// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/machine_survey.hpp"

namespace isobar::tools {

/// A configuration of about ten lines for the machine that was looked at, with an end mark. Comments say what
/// was found and what was not.
std::string proposal(const Survey& survey);

}  // namespace isobar::tools
