// SPDX-License-Identifier: BSD-3-Clause
// Subscriber built on another vendor's DDS (Fast DDS), with only the ROS 2 names of topics and types in
// common with Isobar. Writes the last message of each topic, with its encapsulation header, to
// FOLDER/TOPIC.cdr.
//   foreign_listener FOLDER DOMAIN SECONDS
// Prints one line per topic: name, number of messages, size of the last one [bytes], largest gap between two
// [ms].
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

struct Expected {
  const char* topic;
  const char* type;
  bool latched;
  bool best_effort = false;
};

constexpr std::array<Expected, 14> kExpected{{
    {"rt/odom", "nav_msgs::msg::dds_::Odometry_", false},
    {"rt/pose", "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_", false},
    {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_", false},
    {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", true},
    {"rt/altitude", "isobar_msgs::msg::dds_::Altitude_", false},
    {"rt/registered_scan", "sensor_msgs::msg::dds_::PointCloud2_", false},
    {"rt/map_cloud", "sensor_msgs::msg::dds_::PointCloud2_", true},
    {"rt/map", "nav_msgs::msg::dds_::OccupancyGrid_", true},
    {"rt/floor", "std_msgs::msg::dds_::Int32_", true},
    {"rt/floor_name", "std_msgs::msg::dds_::String_", true},
    {"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_", false},
    {"ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", true},
    {"rt/roof/fluid_pressure", "sensor_msgs::msg::dds_::FluidPressure_", false, true},
    {"rt/roof/temperature", "sensor_msgs::msg::dds_::Temperature_", false, true},
}};

using Bytes = std::vector<unsigned char>;

/// Stores a message as its serialized bytes.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const char* name) {
    setName(name);
    m_typeSize = 4U << 20;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* /*data*/, rtps::SerializedPayload_t* /*payload*/) override { return false; }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*force*/) override { return false; }
};

class Recorder : public fast::DataReaderListener {
 public:
  void on_data_available(fast::DataReader* reader) override {
    const std::lock_guard lock(mutex_);
    Bytes bytes;
    fast::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) {
        continue;
      }
      const auto now = std::chrono::steady_clock::now();
      if (count_++ > 0) {
        largest_gap_ = std::max(largest_gap_, now - last_time_);
      }
      last_time_ = now;
      last_.swap(bytes);
    }
  }

  void finish(const std::string& folder, const Expected& expected) {
    const std::lock_guard lock(mutex_);
    const auto gap_ms = std::chrono::duration_cast<std::chrono::milliseconds>(largest_gap_).count();
    std::printf("%s %lu %zu %ld\n", expected.topic, count_, last_.size(), static_cast<long>(gap_ms));
    std::string name(expected.topic);
    std::replace(name.begin(), name.end(), '/', '.');
    if (std::FILE* file = std::fopen((folder + "/" + name + ".cdr").c_str(), "wb")) {
      std::fwrite(last_.data(), 1, last_.size(), file);
      std::fclose(file);
    }
  }

 private:
  std::mutex mutex_;
  Bytes last_;
  unsigned long count_ = 0;
  std::chrono::steady_clock::time_point last_time_;
  std::chrono::steady_clock::duration largest_gap_{};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    return 64;
  }
  auto* participant = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<unsigned>(std::atoi(argv[2])), fast::PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) {
    return 69;
  }
  auto* subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  std::array<Recorder, kExpected.size()> recorders;
  for (std::size_t i = 0; i < kExpected.size(); ++i) {
    const Expected& expected = kExpected[i];
    if (participant->find_type(expected.type).empty()) {
      fast::TypeSupport(new RawType(expected.type)).register_type(participant);
    }
    auto* topic = participant->create_topic(expected.topic, expected.type, fast::TOPIC_QOS_DEFAULT);
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind =
        expected.best_effort ? fast::BEST_EFFORT_RELIABILITY_QOS : fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        expected.latched ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 20;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    if (subscriber->create_datareader(topic, qos, &recorders[i]) == nullptr) {
      return 69;
    }
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(std::atof(argv[3])));
  for (std::size_t i = 0; i < kExpected.size(); ++i) {
    recorders[i].finish(argv[1], kExpected[i]);
  }
  std::fflush(stdout);
  // Without Fast DDS's clean-up, which takes seconds and is not under test.
  std::_Exit(0);
}
