// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/import/import_plan.hpp"

namespace isobar::tools {

/// Puts the headers of different senders on one clock, that of the lidar's headers, by the recorder's times, and says what
/// was apart. Where headers tell no time, the recorder's times are used.
void align_clocks(const TopicSurvey& survey, ImportPlan& plan, std::vector<std::string>& notes);

}  // namespace isobar::tools
