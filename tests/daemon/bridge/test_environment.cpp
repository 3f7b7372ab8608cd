// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/environment.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/errors.hpp"
#include "core/text_list.hpp"

namespace isobar::test::test_environment {

using bridge::apply_environment;
using bridge::Environment;

namespace {

using Variables = std::map<std::string, std::string>;

Environment apply(dds::DdsConfig& config, const Variables& variables) {
  return apply_environment(config, [&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::string() : found->second;
  });
}

TEST_CASE("ROS_DOMAIN_ID is the domain unless the configuration sets one") {
  dds::DdsConfig open;
  CHECK(apply(open, {{"ROS_DOMAIN_ID", "42"}}).notes.size() == 1);
  CHECK(open.domain_id == 42);
  dds::DdsConfig nothing;
  CHECK(apply(nothing, {}).notes.empty());
  CHECK(nothing.domain_id == 0);
  dds::DdsConfig set;
  set.domain_id = 0;
  apply(set, {{"ROS_DOMAIN_ID", "42"}});
  CHECK(set.domain_id == 0);
  for (const char* wrong : {"x", "4x", "-1", "233", "99999999999"}) {
    CAPTURE(wrong);
    dds::DdsConfig config;
    CHECK_THROWS_WITH_AS(apply(config, {{"ROS_DOMAIN_ID", wrong}}), doctest::Contains("ROS_DOMAIN_ID"),
                         ConfigError);
  }
}

TEST_CASE("ROS_LOCALHOST_ONLY and its successor leave loopback only, whatever else is set") {
  for (const Variables& variables : {Variables{{"ROS_LOCALHOST_ONLY", "1"}, {"ROS_STATIC_PEERS", "10.0.0.1"}},
                                     Variables{{"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}}}) {
    dds::DdsConfig config;
    config.network_interface = "wlan0";
    config.peers = "10.0.0.9";
    apply(config, variables);
    CHECK(config.network_interface == "lo");
    CHECK(config.peers.empty());
  }
  dds::DdsConfig config;
  apply(config, {{"ROS_LOCALHOST_ONLY", "0"}});
  CHECK(config.network_interface.empty());
}

TEST_CASE("ROS_STATIC_PEERS come beside dds.peers; a host name is told and not used") {
  dds::DdsConfig config;
  config.peers = "10.0.0.9";
  const Environment environment = apply(config, {{"ROS_STATIC_PEERS", "10.0.0.1;base.local; 10.0.0.2"}});
  CHECK(split_list(config.peers) == std::vector<std::string>{"10.0.0.9", "10.0.0.1", "10.0.0.2"});
  CHECK(environment.notes.at(1).find("base.local") != std::string::npos);
}

TEST_CASE("CYCLONEDDS_URI is passed on, and its interfaces are found in its text and in its files") {
  const std::string file = std::filesystem::temp_directory_path() / "isobar_test_environment.xml";
  std::ofstream(file) << "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"eth0\"/>"
                         "</Interfaces></General></Domain></CycloneDDS>";
  dds::DdsConfig config;
  const std::string plain = "<CycloneDDS><Domain/></CycloneDDS>";
  CHECK(apply(config, {{"CYCLONEDDS_URI", plain}}).uri == plain);
  CHECK_FALSE(apply(config, {{"CYCLONEDDS_URI", plain}}).uri_names_interfaces);
  CHECK(apply(config, {{"CYCLONEDDS_URI", plain + ",file://" + file}}).uri_names_interfaces);
  CHECK(apply(config, {{"CYCLONEDDS_URI", file}}).uri_names_interfaces);
  CHECK_FALSE(apply(config, {{"CYCLONEDDS_URI", "file:///nowhere.xml"}}).uri_names_interfaces);
  std::filesystem::remove(file);
}

TEST_CASE("a list in a text has its elements without spaces; a comma at its end leaves an empty one") {
  using List = std::vector<std::string>;
  CHECK(split_list("").empty());
  CHECK(split_list("a") == List{"a"});
  CHECK(split_list(" a b , c ") == List{"a b", "c"});
  CHECK(split_list("a,") == List{"a", ""});
  CHECK(split_list(" ") == List{""});
}

}  // namespace

}  // namespace isobar::test::test_environment
