// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/writer_watch.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace isobar::dds {
namespace {

/// Longest text of a health entry.
constexpr std::size_t kMaxBytes = 119;

std::string topic_name(dds_entity_t topic) {
  std::array<char, 256> name{};
  return dds_get_name(topic, name.data(), name.size()) > 0 ? std::string(name.data()) : std::string{};
}

std::string type_name(dds_entity_t topic) {
  std::array<char, 256> name{};
  return dds_get_type_name(topic, name.data(), name.size()) > 0 ? std::string(name.data()) : std::string{};
}

const char* policy_name(std::uint32_t policy) {
  switch (policy) {
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "durability";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "deadline";
    case DDS_OWNERSHIP_QOS_POLICY_ID:
      return "ownership";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "liveliness";
    case DDS_DATA_REPRESENTATION_QOS_POLICY_ID:
      return "data representation";
    default:
      return "quality of service";
  }
}

std::string qos_sentence(const char* input, std::uint32_t policy) {
  if (policy == DDS_RELIABILITY_QOS_POLICY_ID) {
    return std::string("the node that writes it offers best effort only: set dds.qos.") + input +
           "_reliability = \"best_effort\"";
  }
  return std::string("the node that writes it offers another ") + policy_name(policy) +
         " than a ROS 2 sensor: change it there";
}

std::string type_sentence(const char* input, const std::string& offered) {
  const std::string remedy = std::string("; name the right topic in dds.topics.") + input;
  const std::string sentence = "its messages are " + ros_type_name(offered);
  return sentence.substr(0, kMaxBytes - std::min(kMaxBytes, remedy.size())) + remedy;
}

}  // namespace

std::string ros_type_name(const std::string& dds_type) {
  std::string name = dds_type;
  constexpr std::string_view kModule = "::dds_::";
  if (const std::size_t at = name.find(kModule); at != std::string::npos && name.back() == '_') {
    name.pop_back();
    name.replace(at, kModule.size(), "/");
  }
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::")) {
    name.replace(at, 2, "/");
  }
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

WriterWatch::WriterWatch(dds_entity_t participant)
    : list_(checked(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
                    "list of writers")) {
  writers_.reserve(kMostWriters);
}

void WriterWatch::look() {
  std::vector<void*> samples(kMostWriters, nullptr);
  std::vector<dds_sample_info_t> infos(kMostWriters);
  writers_.clear();
  const dds_return_t count =
      dds_read_mask(list_.get(), samples.data(), infos.data(), kMostWriters, kMostWriters,
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  if (count <= 0) return;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (!infos[i].valid_data) continue;
    const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    writers_.push_back({writer.topic_name, writer.type_name});
  }
  dds_return_loan(list_.get(), samples.data(), count);
}

std::string WriterWatch::trouble(const InputReader& input) const {
  // Not the matched status, whose changes its own reader looks for.
  dds_instance_handle_t first = 0;
  if (dds_get_matched_publications(input.reader, &first, 1) != 0) return {};
  const dds_entity_t topic = dds_get_topic(input.reader);
  const std::string name = topic_name(topic);
  const std::string type = type_name(topic);
  const auto here = [&](bool same_type) {
    return std::find_if(writers_.begin(), writers_.end(), [&](const Found& writer) {
      return writer.topic == name && (writer.type == type) == same_type;
    });
  };
  dds_requested_incompatible_qos_status_t qos{};
  if (here(true) != writers_.end() &&
      dds_get_requested_incompatible_qos_status(input.reader, &qos) == DDS_RETCODE_OK &&
      qos.total_count > 0) {
    return qos_sentence(input.input, qos.last_policy_id);
  }
  const auto other = here(false);
  return other == writers_.end() ? std::string{} : type_sentence(input.input, other->type);
}

}  // namespace isobar::dds
