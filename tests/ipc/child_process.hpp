// SPDX-License-Identifier: BSD-3-Clause
// A program that a test starts, reads from and ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace isobar::test {

class ChildProcess {
 public:
  /// Starts arguments[0]; its standard output (and error) comes back through read_line().
  explicit ChildProcess(const std::vector<std::string>& arguments);
  ~ChildProcess();  ///< kills it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// The next line without its end. False when none came in time or the program closed its output.
  bool read_line(std::string& line, std::chrono::milliseconds timeout);
  /// Reads lines until one contains `text`.
  bool read_until(const std::string& text, std::chrono::milliseconds timeout);
  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Exit code, 128 + signal when a signal ended it, -1 when it still runs after the timeout.
  int wait(std::chrono::milliseconds timeout);
  [[nodiscard]] bool running();
  [[nodiscard]] const std::string& output() const { return output_; }  ///< all that was read so far

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  int exit_code_ = -1;
  std::string pending_;
  std::string output_;
};

}  // namespace isobar::test
