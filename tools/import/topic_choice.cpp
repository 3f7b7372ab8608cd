// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/topic_choice.hpp"

#include <algorithm>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "run/recording/unit_words.hpp"
#include "tools/import/request.hpp"

namespace isobar::tools {
namespace {

std::string list_of(const TopicSurvey& survey, const std::vector<std::size_t>& topics) {
  std::string text;
  for (const std::size_t index : topics) {
    text += (text.empty() ? "" : ", ") + printable(survey.topics[index].channel.topic);
  }
  return text.empty() ? "none" : text;
}

}  // namespace

bool names_one_of(const std::string& topic, std::initializer_list<const char*> words) {
  const std::string lower = recording::lower_case(topic);
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return lower.find(word) != std::string::npos; });
}

std::optional<std::size_t> choose_topic(const TopicSurvey& survey, const std::string& chosen,
                                        const char* option,
                                        const std::function<bool(const TopicFindings&)>& is_candidate,
                                        const std::function<bool(const TopicFindings&)>& is_likely) {
  if (chosen == kNoTopic) return std::nullopt;
  std::vector<std::size_t> candidates;
  std::vector<std::size_t> likely;
  for (std::size_t i = 0; i < survey.topics.size(); ++i) {
    const TopicFindings& topic = survey.topics[i];
    if (!topic.is_usable() || !is_candidate(topic)) continue;
    if (topic.channel.topic == chosen) return i;
    candidates.push_back(i);
    if (is_likely(topic)) likely.push_back(i);
  }
  if (!chosen.empty()) {
    throw UsageError(std::string(option) + ": " + printable(chosen) +
                     " is no topic with messages that it can be; there are " + list_of(survey, candidates));
  }
  if (likely.size() > 1) {
    throw UsageError(std::string(option) + ": there are several: " + list_of(survey, likely) + "; say " +
                     option + " " + printable(survey.topics[likely.front()].channel.topic) +
                     " or another one, or " + option + " none");
  }
  return likely.empty() ? std::nullopt : std::optional(likely.front());
}

}  // namespace isobar::tools
