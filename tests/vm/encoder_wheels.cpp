// SPDX-License-Identifier: BSD-3-Clause
// Two encoders on lines 0 to 3 of the kernel's simulated GPIO chip: turned through its files in sysfs, and read back
// through libgpiod by the driver of isobard, to compare the counts.
// Usage: encoder_wheels FOLDER EDGES_PER_SECOND SECONDS [CHIP]
//   FOLDER            of the chip's sim_gpioN in sysfs
//   EDGES_PER_SECOND  of both together; 0: an edge of each wheel as soon as those before have been read
//   CHIP              "/dev/gpiochip0": reads it as well; without: turns only
#include <fcntl.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "drivers/encoder/gpio_lines.hpp"
#include "drivers/encoder/sensor.hpp"
#include "tests/drivers/encoder/turning_wheel.hpp"

namespace {

using namespace isobar;

std::int64_t steady_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

/// The files that pull the lines up and down.
class Lines {
 public:
  explicit Lines(const std::string& folder) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      files_[i] = open((folder + "/sim_gpio" + std::to_string(i) + "/pull").c_str(), O_WRONLY | O_CLOEXEC);
    }
  }
  [[nodiscard]] bool set(const encoder::Edge& edge) const {
    const std::string word = edge.rising ? "pull-up" : "pull-down";
    const int file = files_[std::size_t{2} * edge.encoder + static_cast<std::size_t>(edge.line)];
    return pwrite(file, word.data(), word.size(), 0) == static_cast<ssize_t>(word.size());
  }

 private:
  std::array<int, 4> files_{};
};

/// One step, and the wait for the next one, as the thread of isobard does.
void step_and_wait(encoder::Sensor& sensor) {
  const Device<WheelSample>::Step step = sensor.step(steady_ns());
  pollfd waits{sensor.file_descriptor(), POLLIN, 0};
  const std::int64_t wait_ns = step.next_ns - steady_ns();
  const timespec wait{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  if (wait_ns > 0) (void)ppoll(&waits, 1, &wait, nullptr);
}

/// The wheels, and the device that reads them.
struct Bench {
  Bench(const char* folder, const char* chip) : lines(folder) {
    if (chip == nullptr) return;
    encoder::Settings settings;
    settings.chip = chip;
    settings.left = {0, 1};
    settings.right = {2, 3};
    sensor = std::make_unique<encoder::Sensor>(settings, std::make_unique<encoder::GpioLines>(settings));
  }
  [[nodiscard]] bool turn(std::size_t wheel, bool forward) {
    return lines.set(wheels[wheel].turn(forward, 0));
  }
  [[nodiscard]] bool is_exact() const {
    return sensor->count(0) == wheels[0].position() && sensor->count(1) == wheels[1].position();
  }

  Lines lines;
  std::array<encoder::TurningWheel, 2> wheels{encoder::TurningWheel(0), encoder::TurningWheel(1)};
  std::unique_ptr<encoder::Sensor> sensor;
};

/// An edge of each wheel at a time, forward and back again. False when a line cannot be set.
/// @param edges receives their number
bool turn_step_by_step(Bench& bench, int seconds, std::int64_t& edges) {
  const std::int64_t end_ns = steady_ns() + seconds * 1'000'000'000LL;
  for (step_and_wait(*bench.sensor); steady_ns() < end_ns; edges += 2) {
    const bool forward = edges / 2'000 % 2 == 0;
    if (!bench.turn(0, forward) || !bench.turn(1, !forward)) return false;
    const std::int64_t give_up_ns = steady_ns() + 1'000'000'000;
    while (!bench.is_exact() && steady_ns() < give_up_ns) step_and_wait(*bench.sensor);
    if (!bench.is_exact()) break;
  }
  return true;
}

/// At a rate, whatever has been read.
bool turn_at(Bench& bench, int edges_per_s, int seconds, std::int64_t& edges) {
  std::atomic<bool> ends = false;
  std::thread reader;
  if (bench.sensor != nullptr) {
    reader = std::thread([&] {
      while (!ends) step_and_wait(*bench.sensor);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  const std::int64_t begin_ns = steady_ns();
  bool are_set = true;
  for (; are_set && edges < std::int64_t{edges_per_s} * seconds; ++edges) {
    while (steady_ns() < begin_ns + edges * 1'000'000'000 / edges_per_s) {
    }
    // Forward, and back again every second.
    const bool forward = edges / edges_per_s % 2 == 0;
    are_set = edges % 2 == 0 ? bench.turn(0, forward) : bench.turn(1, !forward);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ends = true;
  if (reader.joinable()) reader.join();
  return are_set;
}

}  // namespace

int main(int count, char** arguments) {
  const int edges_per_s = count >= 4 ? std::atoi(arguments[2]) : -1;
  if (count > 5 || edges_per_s < 0 || (edges_per_s == 0 && count != 5)) {
    std::fprintf(stderr, "usage: encoder_wheels FOLDER EDGES_PER_SECOND SECONDS [CHIP]\n");
    return 64;
  }
  Bench bench(arguments[1], count == 5 ? arguments[4] : nullptr);
  const int seconds = std::atoi(arguments[3]);
  std::int64_t edges = 0;
  const std::int64_t begin_ns = steady_ns();
  const bool are_set = edges_per_s == 0 ? turn_step_by_step(bench, seconds, edges)
                                        : turn_at(bench, edges_per_s, seconds, edges);
  if (!are_set) {
    std::fprintf(stderr, "encoder_wheels: a line in %s cannot be set\n", arguments[1]);
    return 69;
  }
  if (bench.sensor == nullptr) return 0;
  // turn_at() waits for a second in all.
  const double elapsed_s =
      static_cast<double>(steady_ns() - begin_ns) * 1e-9 - (edges_per_s == 0 ? 0.0 : 1.0);
  std::printf(
      "encoders: %lld edges, %.0f a second: left %lld of %lld, right %lld of %lld, %llu lost: %s\n",
      static_cast<long long>(edges), static_cast<double>(edges) / elapsed_s,
      static_cast<long long>(bench.sensor->count(0)), static_cast<long long>(bench.wheels[0].position()),
      static_cast<long long>(bench.sensor->count(1)), static_cast<long long>(bench.wheels[1].position()),
      static_cast<unsigned long long>(bench.sensor->status().counters.corrupt),
      bench.is_exact() ? "exact" : "differs");
  return bench.is_exact() && edges > 0 ? 0 : 1;
}
