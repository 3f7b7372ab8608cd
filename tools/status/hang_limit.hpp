// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace isobar::tools {

/// Time limit for calls into shared memory, which wait for an answer of isobard without limit: while isobard hangs
/// or is stopped, the program says so and ends instead of waiting with it. One at a time.
class HangLimit {
 public:
  /// @param exit_code of the program after the limit; kWait: it says so and goes on waiting
  HangLimit(unsigned seconds, int exit_code) {
    exit_code_ = exit_code;
    std::signal(SIGALRM, &HangLimit::end);
    alarm(seconds);
  }
  ~HangLimit() { alarm(0); }
  HangLimit(const HangLimit&) = delete;
  HangLimit& operator=(const HangLimit&) = delete;

  static constexpr int kWait = -1;

 private:
  static void end(int /*signal*/) {
    constexpr std::string_view kText =
        "isobar: isobard runs but does not answer: it hangs or was stopped (systemctl status isobard)\n";
    static_cast<void>(::write(STDERR_FILENO, kText.data(), kText.size()) > 0);
    if (exit_code_ != kWait) _exit(exit_code_);
  }
  static inline volatile std::sig_atomic_t exit_code_ = 0;
};

}  // namespace isobar::tools
