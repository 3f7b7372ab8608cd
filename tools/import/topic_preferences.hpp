// SPDX-License-Identifier: BSD-3-Clause
// Which of several topics of one kind is the sensor itself: bags hold filtered copies, maps, depth cameras and radars beside it.
#pragma once

#include <algorithm>
#include <vector>

#include "tools/import/request.hpp"
#include "tools/import/topic_survey.hpp"

namespace isobar::tools {

[[nodiscard]] inline bool is_among(const TopicFindings& topic,
                                   const std::vector<const TopicFindings*>& topics) {
  return std::find(topics.begin(), topics.end(), &topic) != topics.end();
}

/// Clouds that are a lidar's own scans, by name and frame; all clouds where none is.
[[nodiscard]] std::vector<const TopicFindings*> likely_clouds(const TopicSurvey& survey);

/// IMUs, without raw copies of the same sensor; of those that are left the ones whose mount is known, else those that are no
/// camera's, else the lidar's own.
/// @param lidar the topic of the lidar; null: none
[[nodiscard]] std::vector<const TopicFindings*> likely_imus(const TopicSurvey& survey,
                                                            const ImportRequest& request,
                                                            const TopicFindings* lidar);

/// Pressures that are no airspeed sensor's, which sends the same type; all where none is.
[[nodiscard]] std::vector<const TopicFindings*> likely_barometers(const TopicSurvey& survey);

}  // namespace isobar::tools
