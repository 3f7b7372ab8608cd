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
  DeviceStates device_states() const override { return {}; }
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
    start({});
  }
  /// A start with a state folder, "" as the text: without a file.
  Program(const TemporaryFolder& state, const std::filesystem::path& file, const std::string& text)
      : file_(file) {
    std::filesystem::remove(file_);
    if (!text.empty()) write(text);
    start(state.path());
  }
  ~Program() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGHUP);
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  [[nodiscard]] std::filesystem::path file() const {
    return file_.empty() ? folder_.path() / "isobar.toml" : file_;
  }
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
  /// A tick of the supervise loop.
  void tick() { configuration_->poll(graph, service_); }
  [[nodiscard]] std::string status() const { return configuration_->status(); }
  [[nodiscard]] const Config& config() const { return configuration_->config(); }
  NotingGraph graph;

 private:
  void start(const std::filesystem::path& state) {
    configuration_ = std::make_unique<Configuration>(
        file().string(), [](Config& config) { config.output.directory = "/of/the/command/line"; }, state);
  }
  TemporaryFolder folder_;
  std::filesystem::path file_;  // empty: in folder_
  NotifySocket manager_;
  Service service_;
  std::unique_ptr<Configuration> configuration_;
};

/// "FILE:LINE"
std::string file_place(const Program& program, int line) {
  return program.file().string() + ":" + std::to_string(line);
}

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

TEST_CASE("a start with bad files goes on with the last good configuration, until the files are right") {
  const TemporaryFolder state;
  const TemporaryFolder etc;
  const auto file = etc.path() / "isobar.toml";
  CHECK_THROWS_AS(Program(state, file, "map.radius_m = 5\n"), ConfigErrors);  // nothing is kept yet
  Program(state, file, "map.radius_m = 55\n").tick();
  for (const char* bad : {"map.radius_m = 5\n", "map.radius_m = \n", "map.radius = 60\n", "\xff", ""}) {
    CAPTURE(bad);
    Program program(state, file, bad);
    CHECK(program.config().map.radius_m == 55.0);
    CHECK(program.config().output.directory == "/of/the/command/line");
    CHECK(has(program.status(), "stays in force; refused: " + file.string()));
    CHECK(has(program.entry("configuration"), "kept from an earlier run, as the files are bad"));
    CHECK(has(program.entry("configuration/refused"), file.string()));
    program.tick();
    program.reload("map.radius_m = 66\n");
    CHECK(program.graph.radius_m == 66.0);
    CHECK(program.entry("configuration/refused").empty());
    CHECK_FALSE(has(program.entry("configuration"), "kept"));
    program.reload("map.radius_m = 55\n");
    program.tick();
  }
}

TEST_CASE("what was never in force is not kept, and what others have written is not used") {
  const TemporaryFolder state;
  const TemporaryFolder etc;
  const auto file = etc.path() / "isobar.toml";
  { const Program never_ran(state, file, "map.radius_m = 55\n"); }
  CHECK_THROWS_AS(Program(state, file, "x"), ConfigErrors);
  Program(state, file, "map.radius_m = 55\n").tick();
  CHECK_THROWS_AS(Program(state, etc.path() / "other.toml", "x"), ConfigErrors);
  std::ofstream(state.path() / kKeptConfigFile, std::ios::app) << "map.radius_m = 77\n";
  CHECK_THROWS_AS(Program(state, file, "x"), ConfigErrors);
  Program(state, file, "map.radius_m = 56\n").tick();  // written anew
  CHECK(Program(state, file, "x").config().map.radius_m == 56.0);
}

TEST_CASE("a folder with files of others is refused at once, not at the next start") {
  const TemporaryFolder foreign;
  std::ofstream(foreign.path() / "thesis.txt") << "x";
  Program program("map.radius_m = 50\n");
  program.reload("[map]\nradius_m = 60\ndirectory = \"" + foreign.path().string() + "\"\n");
  CHECK(has(program.entry("configuration/refused"), file_place(program, 3) + ":13: map.directory: "));
  CHECK(program.graph.changes == 0);
}

TEST_CASE("a file with equal values asks nothing of the stages") {
  Program program("map.radius_m = 50\n");
  program.reload("# other words\n[map]\nradius_m = 50\n");
  CHECK(program.graph.changes == 0);
}

}  // namespace isobar::test::test_configuration
