// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/topic_preferences.hpp"

#include <algorithm>
#include <functional>

#include "tools/import/topic_choice.hpp"

namespace isobar::tools {
namespace {

using Topics = std::vector<const TopicFindings*>;

Topics usable(const TopicSurvey& survey, const std::function<bool(const TopicFindings&)>& is_kind) {
  Topics found;
  for (const TopicFindings& topic : survey.topics) {
    if (topic.is_usable() && is_kind(topic)) found.push_back(&topic);
  }
  return found;
}

/// Keeps the topics that have a property, where any has it.
void prefer(Topics& topics, const std::function<bool(const TopicFindings&)>& has) {
  Topics kept;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(kept),
               [&](const TopicFindings* topic) { return has(*topic); });
  if (!kept.empty()) topics = std::move(kept);
}

bool is_raw(const TopicFindings& topic) { return names_one_of(topic.channel.topic, {"raw", "uncalibrated"}); }

/// "/os1_cloud_node1/" of "/os1_cloud_node1/points".
std::string name_space(const TopicFindings& topic) {
  return topic.channel.topic.substr(0, topic.channel.topic.rfind('/') + 1);
}

/// One sensor under two names: the copy that a driver or a filter has corrected is used.
void drop_raw_copies(Topics& topics) {
  const Topics all = topics;
  std::erase_if(topics, [&](const TopicFindings* topic) {
    return is_raw(*topic) && std::any_of(all.begin(), all.end(), [&](const TopicFindings* other) {
             return !is_raw(*other) && other->frame_id == topic->frame_id &&
                    name_space(*other) == name_space(*topic);
           });
  });
}

}  // namespace

std::vector<const TopicFindings*> likely_clouds(const TopicSurvey& survey) {
  Topics clouds = usable(survey, [](const TopicFindings& topic) {
    return topic.kind == TopicKind::kCloud || topic.kind == TopicKind::kLivox;
  });
  prefer(clouds, [](const TopicFindings& topic) {
    const bool is_other = names_one_of(
        topic.channel.topic,
        {"map",      "regist",  "filter",      "ground",    "obstacle", "segment", "cluster", "feature",
         "corner",   "surf",    "global",      "accumul",   "aggreg",   "submap",  "camera",  "depth",
         "stereo",   "radar",   "deskew",      "undist",    "crop",     "voxel",   "downsam", "path",
         "frontier", "terrain", "laser_cloud", "realsense", "zed",      "d435",    "d455"});
    // A driver's cloud is in the frame of its sensor.
    const bool is_of_world = names_one_of(topic.frame_id, {"map", "odom", "world", "camera_init"});
    return !is_other && !is_of_world;
  });
  return clouds;
}

std::vector<const TopicFindings*> likely_imus(const TopicSurvey& survey, const ImportRequest& request,
                                              const TopicFindings* lidar) {
  Topics imus = usable(survey, [](const TopicFindings& topic) { return topic.kind == TopicKind::kImu; });
  drop_raw_copies(imus);
  if (request.mounts().contains("imu") || lidar == nullptr) return imus;
  if (imus.size() > 1) {
    prefer(imus, [&](const TopicFindings& topic) {
      return topic.frame_id == lidar->frame_id ||
             survey.frames.find(lidar->frame_id, topic.frame_id).has_value();
    });
  }
  prefer(imus, [](const TopicFindings& topic) {
    return !names_one_of(topic.channel.topic, {"camera", "realsense", "zed", "d435", "d455", "t265", "oak"});
  });
  if (imus.size() > 1) {
    prefer(imus, [&](const TopicFindings& topic) { return name_space(topic) == name_space(*lidar); });
  }
  return imus;
}

std::vector<const TopicFindings*> likely_barometers(const TopicSurvey& survey) {
  Topics topics =
      usable(survey, [](const TopicFindings& topic) { return topic.kind == TopicKind::kPressure; });
  prefer(topics, [](const TopicFindings& topic) {
    return !names_one_of(topic.channel.topic, {"diff", "airspeed", "pitot"});
  });
  return topics;
}

}  // namespace isobar::tools
