// SPDX-License-Identifier: BSD-3-Clause
#include "tools/stop_signals.hpp"

#include <csignal>
#include <cstring>
#include <string>

namespace isobar::tools {
namespace {

volatile std::sig_atomic_t g_stop_signal = 0;

}  // namespace

Stopped::Stopped(int number)
    : Error(std::string("stopped (") + sigdescr_np(number) + "); what was begun is removed", 128 + number) {}

StopSignals::StopSignals() {
  g_stop_signal = 0;
  for (std::size_t i = 0; i < kNumbers.size(); ++i) {
    struct sigaction action {};
    const bool is_stop = kNumbers[i] != SIGPIPE && kNumbers[i] != SIGXFSZ;
    if (is_stop) {
      action.sa_handler = [](int number) { g_stop_signal = number; };
      action.sa_flags = SA_RESETHAND | SA_RESTART;
    } else {
      action.sa_handler = SIG_IGN;
    }
    sigaction(kNumbers[i], nullptr, &before_[i]);
    // nohup and background jobs of a shell ignore a signal on purpose.
    if (before_[i].sa_handler != SIG_IGN) sigaction(kNumbers[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kNumbers.size(); ++i) sigaction(kNumbers[i], &before_[i], nullptr);
}

void StopSignals::check() {
  if (g_stop_signal != 0) throw Stopped(g_stop_signal);
}

}  // namespace isobar::tools
