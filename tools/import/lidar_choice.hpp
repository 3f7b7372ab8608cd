// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/import/import_plan.hpp"

namespace isobar::tools {

/// Chooses the topic of the lidar and puts it into the plan: packets of a known model, else clouds.
/// @param becomes by topic; receives what the topics become
/// @throws UsageError naming --lidar, --model or --calibration
void choose_lidar(const TopicSurvey& survey, const ImportRequest& request, ImportPlan& plan,
                  std::vector<std::string>& becomes, std::vector<std::string>& notes);

}  // namespace isobar::tools
