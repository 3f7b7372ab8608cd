// SPDX-License-Identifier: BSD-3-Clause
// Time from the start of the process to isobard's line "ready: …".
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <string>

#include "tests/benchmark/micro/percentiles.hpp"

namespace {

using Clock = std::chrono::steady_clock;

/// An isobard with the default configuration and captured output.
class Isobard {
 public:
  Isobard() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::string name = ISOBARD;
    std::array<char*, 2> arguments{name.data(), nullptr};
    if (posix_spawn(&process_, ISOBARD, &actions, nullptr, arguments.data(), environ) != 0) process_ = -1;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    output_ = ends[0];
  }
  ~Isobard() {
    if (process_ > 0) {
      kill(process_, SIGTERM);
      waitpid(process_, nullptr, 0);
    }
    if (output_ >= 0) close(output_);
  }
  Isobard(const Isobard&) = delete;
  Isobard& operator=(const Isobard&) = delete;

  /// Waits until isobard is ready.
  /// @return false if it ended first; said() is then its output
  bool wait_until_ready() {
    std::array<char, 4096> bytes{};
    while (text_.find("ready:") == std::string::npos) {
      const ssize_t count = read(output_, bytes.data(), bytes.size());
      if (count <= 0) return false;
      text_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return true;
  }
  [[nodiscard]] const std::string& said() const { return text_; }

 private:
  pid_t process_ = -1;
  int output_ = -1;
  std::string text_;
};

void start_up(benchmark::State& state) {
  std::vector<double> times_ms;
  for (auto _ : state) {
    const Clock::time_point started = Clock::now();
    Isobard isobard;
    if (!isobard.wait_until_ready()) {
      state.SkipWithError(("isobard ended: " + isobard.said()).c_str());
      break;
    }
    const std::chrono::duration<double> took = Clock::now() - started;
    state.SetIterationTime(took.count());
    times_ms.push_back(took.count() * 1e3);
  }
  isobar::bench::count_percentiles(state, times_ms, "ms");
}

BENCHMARK(start_up)->UseManualTime()->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace
