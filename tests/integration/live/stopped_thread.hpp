// SPDX-License-Identifier: BSD-3-Clause
// Stops one thread of another process, as a hung system call or a starved core would.
#pragma once

#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace isobar::test {

class StoppedThread {
 public:
  /// Stops the thread of that name for the lifetime of this object. ptrace requires construction and
  /// destruction in one thread.
  StoppedThread(pid_t process, const std::string& name) : thread_(find(process, name)) {
    if (::ptrace(PTRACE_SEIZE, thread_, nullptr, nullptr) != 0 ||
        ::ptrace(PTRACE_INTERRUPT, thread_, nullptr, nullptr) != 0 ||
        ::waitpid(thread_, nullptr, __WALL) != thread_) {
      throw std::runtime_error("the thread " + name + " cannot be stopped");
    }
  }
  ~StoppedThread() { ::ptrace(PTRACE_DETACH, thread_, nullptr, nullptr); }
  StoppedThread(const StoppedThread&) = delete;
  StoppedThread& operator=(const StoppedThread&) = delete;

 private:
  static pid_t find(pid_t process, const std::string& name) {
    const auto tasks = std::filesystem::path("/proc") / std::to_string(process) / "task";
    for (const auto& task : std::filesystem::directory_iterator(tasks)) {
      std::string comm;
      std::getline(std::ifstream(task.path() / "comm") >> std::ws, comm);
      if (comm == name) return std::stoi(task.path().filename().string());
    }
    throw std::runtime_error("no thread " + name);
  }

  pid_t thread_;
};

}  // namespace isobar::test
