// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/topic_survey.hpp"

namespace isobar::tools {

/// Whether a topic's name holds one of the words, in upper or lower case.
[[nodiscard]] bool names_one_of(const std::string& topic, std::initializer_list<const char*> words);

/// Chooses one topic.
/// @param chosen a topic's name, "none", or empty
/// @param option "--imu", for errors
/// @param is_candidate whether the topic can be it at all: a named one must be
/// @param is_likely whether it is taken unasked
/// @throws UsageError naming the option: several topics are likely, or the named one is none
[[nodiscard]] std::optional<std::size_t> choose_topic(
    const TopicSurvey& survey, const std::string& chosen, const char* option,
    const std::function<bool(const TopicFindings&)>& is_candidate,
    const std::function<bool(const TopicFindings&)>& is_likely);

}  // namespace isobar::tools
