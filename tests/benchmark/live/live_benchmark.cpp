// SPDX-License-Identifier: BSD-3-Clause
// Live benchmark of isobard and isobar-dds: this process plays a recording over UDP in real time and is the
// DDS subscriber. One machine, one clock. Started by `run`, which isolates it.
#include <fmt/format.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "daemon/stage_settings.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/benchmark/live/listeners.hpp"
#include "tests/benchmark/live/report.hpp"
#include "tests/benchmark/live/sender.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::benchmark {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;

struct Options {
  std::filesystem::path recording;
  std::string json;
  double seconds = 60.0;
  double warm_up_s = 5.0;
  bool ordinary_scheduling = false;
  bool stress = false;
  bool check = false;
  bool queues = false;
};

/// Writes the configuration of the measurement for both programs.
std::filesystem::path write_config(const Options& options, const recording::Manifest& manifest) {
  Config config = with_sensors_of(manifest, Config{});
  config.realtime.enabled = !options.ordinary_scheduling;
  const auto file = std::filesystem::temp_directory_path() / "isobar-live-benchmark.toml";
  files::write_text_file(file, show_config(config));
  return file;
}

/// A phase of the measurement.
PhaseResult measure(const std::string& name, double seconds, const Programs& programs, Sender& sender,
                    PoseListener& poses, MemoryListener& memory) {
  const Reading before = read(programs, memory);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const Reading after = read(programs, memory);
  std::this_thread::sleep_for(200ms);  // the last messages are still in transit
  return evaluate(name, before, after, sender, poses, memory);
}

int run(const Options& options) {
  const recording::RecordingReader reader(options.recording);
  const std::string config = write_config(options, reader.manifest());
  ChildProcess isobard({ISOBAR_DAEMON, "--config", config});
  if (!isobard.read_until("ready:", 20s)) throw ServiceError("isobard does not start: " + isobard.output());
  ChildProcess bridge({ISOBAR_DDS_PROGRAM, "--config", config});
  if (!bridge.read_until("attached", 20s))
    throw ServiceError("isobar-dds does not attach: " + bridge.output());
  PoseListener poses;
  MemoryListener memory(options.queues);
  Sender sender(options.recording, static_cast<std::uint16_t>(reader.manifest().lidar->port));
  std::this_thread::sleep_for(std::chrono::duration<double>(options.warm_up_s));

  const Programs programs{isobard.pid(), bridge.pid()};
  std::vector<PhaseResult> results;
  results.push_back(measure("idle", options.seconds, programs, sender, poses, memory));
  if (options.stress) {
    ChildProcess stress({"/usr/bin/stress-ng", "--cpu", "4"});
    std::this_thread::sleep_for(1s);
    if (!stress.running()) throw ServiceError("stress-ng does not run: " + stress.output());
    results.push_back(measure("stress", options.seconds, programs, sender, poses, memory));
    stress.signal(SIGTERM);
    static_cast<void>(stress.wait(5s));
  }
  if (!isobard.running() || !bridge.running())
    throw ServiceError("isobard or isobar-dds ended during the run");
  if (sender.ended()) throw DataError(options.recording.string() + ": must be longer than the measurement");
  fmt::print("{}", table(results));
  if (!options.json.empty()) files::write_text_file(options.json, json(results));
  return options.check && !targets_met(results) ? 1 : 0;
}

int main_with_errors(int argc, char** argv) {
  CLI::App app{"Latency and processor time of the live pipeline, measured in another process"};
  Options options;
  app.add_option("RECORDING", options.recording, "recording folder, played in real time")->required();
  app.add_option("--seconds", options.seconds, "length of a phase [s]")->capture_default_str();
  app.add_option("--warm-up", options.warm_up_s, "time before the first phase [s]")->capture_default_str();
  app.add_option("--json", options.json, "file for all figures");
  app.add_flag("--ordinary-scheduling", options.ordinary_scheduling, "realtime.enabled = false");
  app.add_flag("--stress", options.stress, "a second phase beside `stress-ng --cpu 4`");
  app.add_flag("--queues", options.queues,
               "also measure the queues in shared memory; isobard then has one more reader to wake");
  app.add_flag("--check", options.check, "exit code 1 if a target is missed");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}

}  // namespace
}  // namespace isobar::benchmark

int main(int argc, char** argv) {
  try {
    return isobar::benchmark::main_with_errors(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "live benchmark: {}\n", error.what());
    return 70;
  }
}
