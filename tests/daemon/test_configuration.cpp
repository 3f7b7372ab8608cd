// SPDX-License-Identifier: BSD-3-Clause
// The configuration in force: accepted, refused, told.
#include "daemon/configuration.hpp"

#include <doctest/doctest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)
#include <unistd.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "daemon/graph.hpp"
#include "daemon/service.hpp"
#include "tests/support/notify_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_configuration {

namespace {

/// A graph without threads that notes what it is asked to change.
class NotingGraph final : public Graph {
 public:
  void start() override {}
  void stop() override {}
  WorkerGroup& workers() override { return workers_; }
  std::string inputs() const override { return {}; }
  BarometerState barometer_state() const override { return {}; }
  void fill_health(std::int64_t /*now_ns*/, ipc::HealthReport& /*report*/) override {}
  Apply apply_of(const Setting& setting) const override { return setting.apply; }
  void apply(const ConfigChange& change) override {
    if (refuses) throw ConfigError("the stage refuses");
    ++changes;
    radius_m = change.running.map.radius_m;
  }
  bool refuses = false;
  int changes = 0;
  double radius_m = 0.0;

 private:
  WorkerGroup workers_;
};

/// A running program in little.
class Program {
 public:
  explicit Program(const std::string& text) {
    write(text);
    configuration_ = std::make_unique<Configuration>(
        file().string(), [](Config& config) { config.output.directory = "/of/the/command/line"; });
  }
  ~Program() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGHUP);
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "isobar.toml"; }
  void write(const std::string& text) const { std::ofstream(file()) << text; }
  /// Writes the file and asks for a reload.
  /// @return what the service manager is told
  std::vector<std::string> reload(const std::string& text) {
    write(text);
    ::kill(::getpid(), SIGHUP);
    configuration_->poll(graph, service_);
    return manager_.messages();
  }
  /// Message of an entry of the health report; empty: no such entry.
  [[nodiscard]] std::string entry(const std::string& name) const {
    ipc::HealthReport report;
    configuration_->fill(report);
    for (std::uint32_t i = 0; i < report.entry_count; ++i) {
      if (name == report.entries[i].name) return report.entries[i].message;
    }
    return {};
  }
  [[nodiscard]] const Config& config() const { return configuration_->config(); }
  NotingGraph graph;

 private:
  TemporaryFolder folder_;
  NotifySocket manager_;
  Service service_;
  std::unique_ptr<Configuration> configuration_;
};

bool has(const std::string& text, const std::string& words) {
  CAPTURE(text);
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a changed file takes effect, and the service manager is told when it begins and ends") {
  Program program("map.radius_m = 50\n");
  CHECK(program.config().output.directory == "/of/the/command/line");
  const auto told = program.reload("map.radius_m = 60\nmap.cell_m = 0.3\n");
  REQUIRE(told.size() == 2);
  CHECK(has(told[0], "RELOADING=1\nMONOTONIC_USEC="));
  CHECK(has(told[1], "READY=1\nSTATUS=configuration "));
  CHECK(has(told[1], "in force; takes effect at the next start: map.cell_m"));
  CHECK(program.graph.changes == 1);
  CHECK(program.graph.radius_m == 60.0);
  CHECK(program.config().map.cell_m == Config{}.map.cell_m);
  CHECK(has(program.entry("configuration/next_start"), "map.cell_m"));
  CHECK(has(program.entry("configuration"),
            "hash " + config_hash(load_layers(program.file()).config) + ", for 0 s, 0 reloads refused"));
}

TEST_CASE("a file that is refused changes nothing, until a good one comes") {
  Program program("map.radius_m = 50\n");
  const std::string before = program.entry("configuration").substr(0, 17);
  for (const char* bad : {"map.radius_m = 5\n", "map.radius_m = \n", "map.radius = 60\n", ""}) {
    const auto told = program.reload(bad);
    REQUIRE(told.size() == 2);
    CHECK(has(told[1], "stays in force; refused: " + program.file().string()));
  }
  CHECK(program.graph.changes == 0);
  CHECK(program.config().map.radius_m == 50.0);
  CHECK(has(program.entry("configuration"), before));
  CHECK(has(program.entry("configuration"), "4 reloads refused"));
  CHECK(has(program.entry("configuration/refused"), "is empty"));
  std::filesystem::remove(program.file());
  program.graph.refuses = true;
  CHECK(has(program.reload("map.radius_m = 61\n").back(), "refused: the stage refuses"));
  CHECK(program.config().map.radius_m == 50.0);
  program.graph.refuses = false;
  program.reload("map.radius_m = 62\n");
  CHECK(program.graph.radius_m == 62.0);
  CHECK(program.entry("configuration/refused").empty());
}

TEST_CASE("a file with equal values asks nothing of the stages") {
  Program program("map.radius_m = 50\n");
  program.reload("# other words\n[map]\nradius_m = 50\n");
  CHECK(program.graph.changes == 0);
}

}  // namespace isobar::test::test_configuration
