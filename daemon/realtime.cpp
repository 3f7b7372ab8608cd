// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <thread>

namespace isobar {

std::string apply_to_this_thread(const ThreadSettings& settings) noexcept {
  std::string refused;
  pthread_setname_np(pthread_self(), settings.name.substr(0, 15).c_str());
  if (!settings.cpus.empty()) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const int cpu : settings.cpus) CPU_SET(static_cast<unsigned>(cpu), &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof(set), &set); error != 0) {
      refused += settings.name + ": cores not set: " + std::strerror(error) + "; ";
    }
  }
  if (settings.fifo_priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = settings.fifo_priority;
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0) {
      refused += settings.name + ": SCHED_FIFO " + std::to_string(settings.fifo_priority) +
                 " refused: " + std::strerror(error) + " (LimitRTPRIO= or CAP_SYS_NICE allows it)";
    }
  }
  // Of the calling thread alone, on Linux. More than before is never refused.
  if (settings.nice > 0) setpriority(PRIO_PROCESS, 0, settings.nice);
  return refused;
}

std::vector<std::string> try_settings(const std::vector<ThreadSettings>& settings) {
  std::vector<std::string> refusals;
  for (const ThreadSettings& wanted : settings) {
    std::string refused;
    std::thread([&] { refused = apply_to_this_thread(wanted); }).join();
    if (!refused.empty()) refusals.push_back(std::move(refused));
  }
  return refusals;
}

std::uint64_t page_faults_of_this_thread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
}

std::string lock_memory() noexcept {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("memory not locked: ") + std::strerror(errno) + " (LimitMEMLOCK=infinity allows it)";
}

}  // namespace isobar
