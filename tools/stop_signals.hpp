// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction is POSIX

#include <array>

#include "core/errors.hpp"

namespace isobar::tools {

/// A person or the system stopped the command: exit code 128 and the signal's number, as shells have it.
class Stopped : public Error {
 public:
  explicit Stopped(int number);
};

/// While it lives, SIGINT, SIGTERM and SIGHUP are kept for check(), so that what was begun is cleaned up; the second one ends
/// the process at once. A reader of the output that goes away (SIGPIPE) or a limit of the file size (SIGXFSZ) becomes an error
/// of the write.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// @throws Stopped after a signal
  static void check();

 private:
  static constexpr std::array<int, 5> kNumbers{SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ};
  std::array<struct sigaction, kNumbers.size()> before_{};
};

}  // namespace isobar::tools
