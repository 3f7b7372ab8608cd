// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/environment.hpp"

#include <arpa/inet.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "core/errors.hpp"
#include "core/text_list.hpp"

namespace isobar::bridge {
namespace {

void apply_domain(dds::DdsConfig& config, const ReadVariable& read, Environment& environment) {
  if (config.domain_id >= 0) return;
  config.domain_id = 0;
  const std::string text = read("ROS_DOMAIN_ID");
  if (text.empty()) return;
  constexpr int kHighest = 232;  // domains beyond have no UDP ports
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), config.domain_id);
  if (error != std::errc() || end != text.data() + text.size() || config.domain_id < 0 ||
      config.domain_id > kHighest) {
    throw ConfigError("environment: ROS_DOMAIN_ID: must be a whole number within 0 … 232 (got " +
                      text.substr(0, 40) + ")");
  }
  environment.notes.push_back("DDS domain " + text + " from ROS_DOMAIN_ID");
}

void apply_range(dds::DdsConfig& config, const ReadVariable& read, Environment& environment) {
  const char* cause = nullptr;
  if (read("ROS_LOCALHOST_ONLY") == "1") cause = "ROS_LOCALHOST_ONLY=1";
  if (read("ROS_AUTOMATIC_DISCOVERY_RANGE") == "LOCALHOST") cause = "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST";
  if (cause == nullptr) return;
  config.network_interface = "lo";
  config.peers.clear();
  environment.notes.push_back(std::string("this machine only, from ") + cause);
}

void apply_peers(dds::DdsConfig& config, const ReadVariable& read, Environment& environment) {
  for (const std::string& peer : split_list(read("ROS_STATIC_PEERS"), ";,")) {
    in_addr address{};
    const bool is_address = inet_pton(AF_INET, peer.c_str(), &address) == 1;
    if (is_address) config.peers += (config.peers.empty() ? "" : ",") + peer;
    environment.notes.push_back(is_address ? "peer " + peer + " from ROS_STATIC_PEERS"
                                           : "ROS_STATIC_PEERS: not an IPv4 address, not used: " + peer);
  }
}

/// Whether a CYCLONEDDS_URI, files and XML separated by commas, says which interfaces to use.
bool names_interfaces(const std::string& uri) {
  const auto speaks_of_them = [](std::string_view text) {
    return text.find("<NetworkInterface") != std::string_view::npos;
  };
  if (speaks_of_them(uri)) return true;
  for (std::string file : split_list(uri)) {
    constexpr std::string_view kScheme = "file://";
    constexpr std::size_t kMostBytes = 65'536;
    if (file.starts_with(kScheme)) file.erase(0, kScheme.size());
    std::string text(kMostBytes, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), kMostBytes);
    if (speaks_of_them(std::string_view(text.data(), static_cast<std::size_t>(stream.gcount())))) return true;
  }
  return false;
}

}  // namespace

std::string read_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

Environment apply_environment(dds::DdsConfig& config, const ReadVariable& read) {
  Environment environment;
  apply_domain(config, read, environment);
  apply_peers(config, read, environment);
  apply_range(config, read, environment);
  environment.uri = read("CYCLONEDDS_URI");
  if (!environment.uri.empty()) {
    environment.uri_names_interfaces = names_interfaces(environment.uri);
    environment.notes.push_back(
        std::string("Cyclone DDS is configured by CYCLONEDDS_URI") +
        (environment.uri_names_interfaces ? ", its interfaces too: dds.network_interface is not used" : ""));
  }
  return environment;
}

}  // namespace isobar::bridge
