// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/lidar_choice.hpp"

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/text/small_file.hpp"
#include "tools/import/topic_choice.hpp"
#include "tools/import/topic_preferences.hpp"

namespace isobar::tools {
namespace {

/// Longest metadata of a lidar.
constexpr std::size_t kMostMetadata = std::size_t{1} << 20U;

class LidarChoice {
 public:
  LidarChoice(const TopicSurvey& survey, const ImportRequest& request, ImportPlan& plan,
              std::vector<std::string>& becomes, std::vector<std::string>& notes)
      : survey_(survey), request_(request), plan_(plan), becomes_(becomes), notes_(notes) {}

  void choose_lidar() {
    if (request_.lidar == kNoTopic) return;
    const std::string metadata = find_metadata();
    const auto packets = choose_topic(
        survey_, is_of_kind(request_.lidar, TopicKind::kPackets) ? request_.lidar : std::string(), "--lidar",
        [](const TopicFindings& topic) { return topic.kind == TopicKind::kPackets; },
        [&](const TopicFindings& topic) {
          return request_.lidar.empty() && !model_of(topic, metadata).empty() && !is_information(topic);
        });
    if (packets) return use_packets(*packets, metadata);
    const auto clouds = likely_clouds(survey_);
    const auto cloud = choose_topic(
        survey_, request_.lidar, "--lidar",
        [](const TopicFindings& topic) {
          return topic.kind == TopicKind::kCloud || topic.kind == TopicKind::kLivox;
        },
        [&](const TopicFindings& topic) { return is_among(topic, clouds); });
    if (cloud) return use_cloud(*cloud);
    for (const TopicFindings& topic : survey_.topics) {
      if (topic.kind == TopicKind::kPackets && topic.is_usable()) say_unknown_model(topic);
    }
  }

 private:
  const TopicFindings& at(std::size_t index) const { return survey_.topics[index]; }

  [[nodiscard]] bool is_of_kind(const std::string& name, TopicKind kind) const {
    for (const TopicFindings& topic : survey_.topics) {
      if (topic.channel.topic == name && topic.kind == kind) return true;
    }
    return false;
  }
  static bool is_ouster(const TopicFindings& topic) {
    return topic.channel.type.find("ouster") != std::string::npos;
  }
  static bool is_information(const TopicFindings& topic) {
    return is_ouster(topic) && names_one_of(topic.channel.topic, {"imu"});
  }

  /// An Ouster's metadata, from --calibration or from a topic.
  [[nodiscard]] std::string find_metadata() const {
    if (!request_.calibration_file.empty()) {
      const text::SmallFile file = text::read_small_file(request_.calibration_file, kMostMetadata);
      if (!file.refusal.empty())
        throw UsageError("--calibration: " + request_.calibration_file + ": " + file.refusal);
      return file.content;
    }
    for (const TopicFindings& topic : survey_.topics) {
      if (topic.kind == TopicKind::kText && topic.text.find("\"prod_line\"") != std::string::npos)
        return topic.text;
    }
    return {};
  }

  /// The model of a topic's packets; empty: unknown.
  [[nodiscard]] std::string model_of(const TopicFindings& topic, const std::string& metadata) const {
    if (!request_.model.empty()) return request_.model;
    if (!is_ouster(topic)) return topic.votes->model();
    const std::size_t at = metadata.find("\"OS-");
    return at != std::string::npos && at + 4 < metadata.size() ? "OS" + metadata.substr(at + 4, 1)
                                                               : std::string();
  }

  void use_packets(std::size_t index, const std::string& metadata) {
    const std::string name = model_of(at(index), metadata);
    const LidarModel* model = find_lidar_model(name);
    if (model == nullptr) {
      throw UsageError(name.empty()
                           ? "--model: " + printable(at(index).channel.topic) +
                                 " holds packets of a lidar that no driver knows; say --model NAME (" +
                                 lidar_model_list() + "), or --lidar TOPIC with a topic of clouds"
                           : "--model: \"" + printable(name) + "\" has no driver; there are " +
                                 lidar_model_list());
    }
    if (model->needs_calibration && metadata.empty()) {
      throw UsageError("--calibration: the packets of an " + name +
                       " need the sensor's metadata: say --calibration FILE.json");
    }
    plan_.lidar = PlannedTopic{index};
    plan_.manifest.lidar = recording::LidarEntry{};
    plan_.manifest.lidar->model = name;
    plan_.manifest.lidar->port = model->port;
    plan_.manifest.lidar->info_port = model->info_port;
    if (!metadata.empty()) {
      plan_.lidar_metadata = metadata;
      plan_.manifest.lidar->calibration_file = is_ouster(at(index)) ? "os.json" : "calibration.csv";
    }
    becomes_[index] = "lidar.pcap: packets of " + name;
    for (std::size_t i = 0; i < survey_.topics.size() && is_ouster(at(index)); ++i) {
      if (!is_information(at(i)) || !at(i).is_usable()) continue;
      plan_.lidar_info = PlannedTopic{i};
      becomes_[i] = "lidar.pcap: packets of its IMU";
    }
  }

  void use_cloud(std::size_t index) {
    plan_.lidar = PlannedTopic{index};
    plan_.manifest.lidar = recording::LidarEntry{};
    plan_.manifest.lidar->model = recording::kCloudModel;
    plan_.manifest.lidar->file = "lidar.clouds";
    becomes_[index] = "lidar.clouds: " + at(index).cloud_text;
  }

  void say_unknown_model(const TopicFindings& topic) {
    const std::string& mismatch = topic.votes->mismatch();
    notes_.push_back(printable(topic.channel.topic) + ": packets of a lidar that no driver knows" +
                     (mismatch.empty() ? "" : " (" + mismatch + ")") +
                     (is_ouster(topic) ? "; an Ouster's need its metadata: --calibration FILE.json" : ""));
  }

  const TopicSurvey& survey_;
  const ImportRequest& request_;
  ImportPlan& plan_;
  std::vector<std::string>& becomes_;
  std::vector<std::string>& notes_;
};

}  // namespace

void choose_lidar(const TopicSurvey& survey, const ImportRequest& request, ImportPlan& plan,
                  std::vector<std::string>& becomes, std::vector<std::string>& notes) {
  LidarChoice(survey, request, plan, becomes, notes).choose_lidar();
}

}  // namespace isobar::tools
