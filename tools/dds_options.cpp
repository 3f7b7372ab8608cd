// SPDX-License-Identifier: BSD-3-Clause
#include "tools/dds_options.hpp"

#include "config/setting_rules.hpp"
#include "core/errors.hpp"
#include "tools/number_option.hpp"

namespace isobar::tools {

namespace {

CLI::Validator ros_name() {
  const auto check = [](const std::string& name) -> std::string {
    if (keeps_rule(TextRule::kRosNameOrEmpty, name)) return {};
    return "\"" + name + "\" is no ROS name: letters, digits, _ and /, each part begins with a letter";
  };
  return {check, "", ""};
}

}  // namespace

void add_dds_options(CLI::App& command, DdsOptions& options, const std::string& when) {
  command.add_option("--domain", options.domain, "DDS domain" + when)
      ->envname("ROS_DOMAIN_ID")
      ->check(number_within(0, 232))
      ->capture_default_str();
  command
      .add_option(
          "--interface", options.network_interface,
          "network interfaces beside loopback, by name or address, separated by commas; default: all" + when)
      ->type_name("NAMES");
  command
      .add_option("--namespace", options.ros_namespace,
                  "namespace of the robot, dds.ros_namespace of its configuration" + when)
      ->type_name("NAME")
      ->check(ros_name());
}

dds::Participant join_dds(const DdsOptions& options) {
  dds::ParticipantSettings settings;
  settings.domain_id = options.domain;
  settings.network_interface = options.network_interface;
  dds::Participant participant(settings);
  if (const auto& missing = participant.interfaces().missing; !missing.empty())
    throw ServiceError("no network interface that is up has the name or address " + missing.front());
  return participant;
}

}  // namespace isobar::tools
