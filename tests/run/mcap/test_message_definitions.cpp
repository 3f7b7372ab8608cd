// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>

#include "core/errors.hpp"
#include "run/mcap/message_definitions.hpp"

namespace isobar::test::test_message_definitions {

using namespace isobar::mcap;

namespace {

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a definition holds each part that its parts name, once") {
  const std::string odometry = message_definition("nav_msgs/msg/Odometry");
  for (const char* part :
       {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
        "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"})
    CHECK(count_of(odometry, "MSG: " + std::string(part) + "\n") == 1);
  CHECK(count_of(odometry, "MSG: ") == 9);
}

TEST_CASE("every type of the table has a definition whose parts are in the table, too") {
  for (const std::string& type : message_types()) {
    const std::string text = message_definition(type);
    CHECK_FALSE(text.empty());
    // A part that is missing in the table would be named by a member and have no MSG line.
    for (const std::string& part : message_types()) {
      const std::string name = part.substr(0, part.find('/')) + part.substr(part.rfind('/'));
      if (count_of(text, "\n" + name + " ") + count_of(text, "\n" + name + "[") > 0)
        CHECK(count_of(text, "MSG: " + name + "\n") == 1);
    }
  }
  CHECK_THROWS_AS((void)message_definition("geometry_msgs/msg/Wrench"), UsageError);
}

}  // namespace isobar::test::test_message_definitions
