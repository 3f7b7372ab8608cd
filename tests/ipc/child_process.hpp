// SPDX-License-Identifier: BSD-3-Clause
// Child process of a test.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace isobar::test {

class ChildProcess {
 public:
  /// Starts the program arguments[0], with its standard output and error piped to read_line().
  /// @throws std::runtime_error when there is no pipe
  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();  ///< kills the process if it is still running
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Reads the next line, without its line feed.
  /// @return false when no line arrives within the timeout, or when the program has closed its output
  bool read_line(std::string& line, std::chrono::milliseconds timeout);
  /// Reads lines until one contains `text`; false as for read_line().
  bool read_until(const std::string& text, std::chrono::milliseconds timeout);
  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// @return exit code; 128 + signal number if a signal ended it; -1 if it is still running after the timeout
  int wait(std::chrono::milliseconds timeout);
  [[nodiscard]] bool running();
  [[nodiscard]] const std::string& output() const { return output_; }  ///< everything read so far

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  int exit_code_ = -1;
  std::string pending_;
  std::string output_;
};

}  // namespace isobar::test
