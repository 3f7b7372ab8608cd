// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/interfaces.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace isobar::test::test_interfaces {

using namespace isobar::dds;

namespace {

const Interface kLo{"lo", "127.0.0.1", 1, true, false, false};
const Interface kLidarNet{"eth0", "192.168.1.77", 2, false, true, true};
const Interface kWifi{"wlan0", "10.0.0.5", 3, false, true, true};
const Interface kContainers{"docker0", "172.17.0.1", 4, false, true, false};
const Interface kVpn{"tun0", "10.8.0.2", 5, false, false, false};

std::vector<std::string> names(const std::vector<Interface>& interfaces) {
  std::vector<std::string> result;
  for (const Interface& interface : interfaces) result.push_back(interface.name);
  return result;
}

using Names = std::vector<std::string>;

TEST_CASE("without a choice every interface is used, hardware first: an Ethernet lidar does not hide Wi-Fi") {
  const InterfaceChoice choice = choose_interfaces({kContainers, kLidarNet, kLo, kWifi}, {});
  CHECK(names(choice.used) == Names{"lo", "eth0", "wlan0", "docker0"});
  CHECK(choice.missing.empty());
  CHECK(choice.left_out.empty());
}

TEST_CASE("beyond Cyclone DDS's limit of four the least promising interfaces are left out and named") {
  const InterfaceChoice choice = choose_interfaces({kVpn, kContainers, kLidarNet, kLo, kWifi}, {});
  CHECK(choice.used.size() == InterfaceChoice::kMost);
  CHECK(names(choice.used).back() == "docker0");
  CHECK(choice.left_out == Names{"tun0"});
}

TEST_CASE("of two addresses of an interface the one that others can reach is used") {
  Interface link_local = kWifi;
  link_local.address = "169.254.3.4";
  const InterfaceChoice choice = choose_interfaces({kLo, link_local, kWifi}, {});
  REQUIRE(choice.used.size() == 2);
  CHECK(choice.used[1].address == "10.0.0.5");
}

TEST_CASE("a choice by name or address has loopback beside it, and names what is missing") {
  const InterfaceChoice choice =
      choose_interfaces({kLo, kLidarNet, kWifi}, {"10.0.0.5", "wlan0", "usb0", "10.1.1.1"});
  CHECK(names(choice.used) == Names{"lo", "wlan0"});
  CHECK(choice.missing == Names{"usb0", "10.1.1.1"});
  CHECK(names(choose_interfaces({kLo, kWifi}, {"lo"}).used) == Names{"lo"});
}

TEST_CASE("another address or another adapter of the same name is a change") {
  Interface moved = kWifi;
  moved.address = "10.0.0.6";
  Interface plugged_in_again = kWifi;
  plugged_in_again.index = 9;
  const InterfaceChoice before = choose_interfaces({kLo, kWifi}, {"wlan0"});
  CHECK(before == choose_interfaces({kLo, kWifi}, {"wlan0"}));
  CHECK_FALSE(before == choose_interfaces({kLo, moved}, {"wlan0"}));
  CHECK_FALSE(before == choose_interfaces({kLo, plugged_in_again}, {"wlan0"}));
  CHECK_FALSE(before == choose_interfaces({kLo}, {"wlan0"}));
}

}  // namespace

}  // namespace isobar::test::test_interfaces
