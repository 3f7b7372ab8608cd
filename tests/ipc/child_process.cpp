// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ipc/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>

namespace isobar::test {
namespace {

int milliseconds_until(std::chrono::steady_clock::time_point deadline) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  return left.count() < 0 ? 0 : static_cast<int>(left.count());
}

int exit_code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::execv(pointers[0], pointers.data());
    std::_Exit(127);
  }
  ::close(ends[1]);
  descriptor_ = ends[0];
}

ChildProcess::~ChildProcess() {
  if (running()) {
    signal(SIGKILL);
    static_cast<void>(wait(std::chrono::seconds(5)));
  }
  ::close(descriptor_);
}

bool ChildProcess::read_line(std::string& line, std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
      line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return true;
    }
    pollfd waiting{descriptor_, POLLIN, 0};
    std::array<char, 4096> bytes{};
    if (::poll(&waiting, 1, milliseconds_until(deadline)) <= 0) {
      return false;
    }
    const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count <= 0) {
      return false;
    }
    pending_.append(bytes.data(), static_cast<std::size_t>(count));
    output_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

bool ChildProcess::read_until(const std::string& text, std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::string line;
  while (read_line(line, std::chrono::milliseconds(milliseconds_until(deadline)))) {
    if (line.find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

void ChildProcess::signal(int number) const {
  if (pid_ > 0) {
    ::kill(pid_, number);
  }
}

bool ChildProcess::running() { return wait(std::chrono::milliseconds(0)) == -1; }

int ChildProcess::wait(std::chrono::milliseconds timeout) {
  if (pid_ <= 0) {
    return exit_code_;
  }
  // A pidfd becomes readable when the process ends.
  const int descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  pollfd waiting{descriptor, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, static_cast<int>(timeout.count()));
  ::close(descriptor);
  int status = 0;
  if (ready > 0 && ::waitpid(pid_, &status, 0) == pid_) {
    pid_ = -1;
    exit_code_ = exit_code_of(status);
  }
  return exit_code_;
}

}  // namespace isobar::test
