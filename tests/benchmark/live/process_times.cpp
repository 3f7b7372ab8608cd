// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/live/process_times.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace isobar::benchmark {
namespace {

std::filesystem::path folder_of(pid_t process) {
  return std::filesystem::path("/proc") / std::to_string(process);
}

}  // namespace

std::map<std::string, ThreadTimes> thread_times(pid_t process) {
  std::map<std::string, ThreadTimes> result;
  std::error_code gone;
  for (const auto& task : std::filesystem::directory_iterator(folder_of(process) / "task", gone)) {
    std::string name;
    ThreadTimes times;
    std::ifstream comm(task.path() / "comm");
    std::ifstream schedstat(task.path() / "schedstat");
    if (!std::getline(comm, name) || !(schedstat >> times.running_ns >> times.waiting_ns >> times.turns)) {
      continue;
    }
    ThreadTimes& sum = result[name];
    sum.running_ns += times.running_ns;
    sum.waiting_ns += times.waiting_ns;
    sum.turns += times.turns;
  }
  return result;
}

ResidentMemory resident_memory(pid_t process) {
  constexpr double kMegabytesPerKilobyte = 1.0 / 1024.0;
  ResidentMemory memory;
  std::ifstream status(folder_of(process) / "status");
  for (std::string word; status >> word;) {
    double* target = word == "VmRSS:" ? &memory.now_mb : word == "VmHWM:" ? &memory.most_mb : nullptr;
    if (target != nullptr && status >> *target) *target *= kMegabytesPerKilobyte;
  }
  return memory;
}

}  // namespace isobar::benchmark
