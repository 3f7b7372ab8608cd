// SPDX-License-Identifier: BSD-3-Clause
// One program decides, the other follows: whatever happens to the files and to either program, isobar-dds
// publishes with the configuration that isobard has in force.
#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/integration/dds/listener.hpp"
#include "tests/ipc/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_follow {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Configuration and state folder of a machine, and both programs.
class Machine {
 public:
  explicit Machine(bool has_state_folder) : has_state_folder_(has_state_folder) {
    std::filesystem::create_directories(folder_.path() / "etc/conf.d");
    std::filesystem::create_directories(folder_.path() / "state");
    write("isobar.toml", "# defaults\n");
  }
  void write(const std::string& file, const std::string& text) const {
    const auto path = folder_.path() / "etc" / file;
    std::ofstream(path.string() + ".new", std::ios::binary) << text;
    std::filesystem::rename(path.string() + ".new", path);
  }
  void name_node(const std::string& name) const {
    write("conf.d/50-site.toml", "dds.node_name = \"" + name + "\"\n");
  }
  [[nodiscard]] std::string file(const std::string& name = "isobar.toml") const {
    return (folder_.path() / "etc" / name).string();
  }
  std::unique_ptr<ChildProcess> start(const char* program, const std::string& config) const {
    std::vector<std::string> arguments;
    if (has_state_folder_) {
      arguments = {"/usr/bin/env", "STATE_DIRECTORY=" + (folder_.path() / "state").string()};
    }
    arguments.insert(arguments.end(), {program, "--config", config});
    return std::make_unique<ChildProcess>(arguments);
  }
  void start_isobard() {
    isobard.reset();
    isobard = start(ISOBAR_DAEMON, file());
    REQUIRE(isobard->read_until("ready:", 20s));
  }
  void start_bridge() {
    bridge.reset();
    bridge = start(ISOBAR_DDS_PROGRAM, file());
    REQUIRE(bridge->read_until("attached to isobard", 20s));
  }

  std::unique_ptr<ChildProcess> isobard;
  std::unique_ptr<ChildProcess> bridge;

 private:
  TemporaryFolder folder_;
  bool has_state_folder_;
};

/// Whether the reports of isobard come from a node of this name, and no longer from another one.
bool comes_from(Listener<dds::DiagnosticsMessage>& listener, const std::string& node) {
  const auto by_node = [&node](const dds::DiagnosticsMessage& message) {
    return find_status(message, node + ": configuration") != nullptr;
  };
  if (!listener.receive(1, by_node, 15s)) return false;
  listener.forget();
  return listener.receive(1, by_node, 5s);
}

}  // namespace

TEST_CASE("whatever happens to files and programs, the bridge has the configuration of isobard") {
  Machine machine(true);
  Listener<dds::DiagnosticsMessage> listener(dds::topics::kDiagnostics);
  machine.name_node("node_0");
  machine.start_isobard();
  machine.start_bridge();
  std::string in_force = "node_0";
  std::mt19937 random(20261129);
  for (int step = 1; step <= 12; ++step) {
    switch (random() % 6) {
      case 0:
      case 1:
        in_force = "node_" + std::to_string(step);
        machine.name_node(in_force);
        break;
      case 2:
        machine.write("conf.d/50-site.toml", "dds.node_name = \"bad\"\ndds.nod_name = 1\n");
        break;
      case 3:  // good TOML that isobard refuses for another reason than the bridge would
        machine.write("conf.d/50-site.toml", "dds.node_name = \"bad\"\nmap.directory = \"/etc\"\n");
        break;
      case 4:
        machine.start_bridge();
        break;
      default:
        machine.start_isobard();
    }
    CAPTURE(step);
    INFO("bridge: " << machine.bridge->output());
    machine.bridge->signal(SIGHUP);  // asks for the files, which do not decide
    CHECK(comes_from(listener, in_force));
  }
}

TEST_CASE("a bridge that starts while the files are bad takes the settings of a running isobard") {
  Machine machine(false);
  Listener<dds::DiagnosticsMessage> listener(dds::topics::kDiagnostics);
  machine.name_node("good");
  machine.start_isobard();
  machine.write("conf.d/50-site.toml", "dds.node_name = \"go");
  machine.start_bridge();
  CHECK(comes_from(listener, "good"));
  machine.isobard.reset();
  const auto alone = machine.start(ISOBAR_DDS_PROGRAM, machine.file());
  CHECK(alone->wait(20s) == 78);
  CHECK(machine.start(ISOBAR_DAEMON, machine.file())->wait(20s) == 78);
}

TEST_CASE("a bridge with another file than isobard uses its own") {
  Machine machine(true);
  Listener<dds::DiagnosticsMessage> listener(dds::topics::kDiagnostics);
  machine.name_node("of_isobard");
  machine.start_isobard();
  std::filesystem::create_directory(machine.file("other"));
  machine.write("other/bridge.toml", "dds.node_name = \"of_bridge\"\n");
  const auto bridge = machine.start(ISOBAR_DDS_PROGRAM, machine.file("other/bridge.toml"));
  REQUIRE(bridge->read_until("another configuration file", 20s));
  CHECK(comes_from(listener, "of_bridge"));
  machine.write("other/bridge.toml", "dds.node_name = \"changed\"\n");
  bridge->signal(SIGHUP);
  CHECK(comes_from(listener, "changed"));
}

}  // namespace isobar::test::test_follow
