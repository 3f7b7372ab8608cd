// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/topic_clocks.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/printable_text.hpp"
#include "run/text/number_text.hpp"

namespace isobar::tools {
namespace {

/// Clocks of two senders that are nearer than this are one clock and two delays.
constexpr std::int64_t kMostDelayNs = 1'000'000'000;

bool tells_no_time(const TopicFindings& topic) {
  return !topic.least_lag_ns || 2 * topic.without_stamp > topic.messages;
}

std::string seconds_text(std::int64_t ns) {
  return text::number_text(std::round(static_cast<double>(ns) * 1e-6) / 1000.0);
}

void align(const TopicFindings& topic, std::int64_t main_ns, PlannedTopic& planned,
           std::vector<std::string>& notes) {
  const std::string name = printable(topic.channel.topic);
  if (tells_no_time(topic)) {
    planned.uses_log_time = true;
    planned.shift_ns = -main_ns;
    notes.push_back("clock: " + name + ": its messages tell no time; the recorder's times are used");
    return;
  }
  const std::int64_t apart_ns = *topic.least_lag_ns - main_ns;
  if (std::abs(apart_ns) < kMostDelayNs) return;
  planned.shift_ns = apart_ns;
  notes.push_back("clock: " + name + ": its clock is " + seconds_text(std::abs(apart_ns)) +
                  (apart_ns > 0 ? " s behind" : " s ahead of") +
                  " the lidar's by the recorder's times; taken out");
}

}  // namespace

void align_clocks(const TopicSurvey& survey, ImportPlan& plan, std::vector<std::string>& notes) {
  std::optional<std::int64_t> main_ns;
  for (const auto* planned : {&plan.lidar, &plan.imu, &plan.pressure, &plan.wheel, &plan.reference}) {
    if (!*planned || main_ns || tells_no_time(survey.topics[(*planned)->index])) continue;
    main_ns = survey.topics[(*planned)->index].least_lag_ns;
  }
  for (auto* planned : {&plan.lidar, &plan.lidar_info, &plan.imu, &plan.pressure, &plan.temperature,
                        &plan.base_pressure, &plan.wheel, &plan.reference}) {
    if (*planned) align(survey.topics[(*planned)->index], main_ns.value_or(0), **planned, notes);
  }
  if (main_ns && std::abs(*main_ns) > kMostDelayNs) {
    notes.push_back("clock: stamps are those of the messages' headers, " + seconds_text(*main_ns) +
                    " s before the recorder's");
  }
}

}  // namespace isobar::tools
