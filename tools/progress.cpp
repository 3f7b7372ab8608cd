// SPDX-License-Identifier: BSD-3-Clause
#include "tools/progress.hpp"

#include <unistd.h>

#include <algorithm>

namespace isobar::tools {

using std::chrono::steady_clock;

Progress::Progress(std::string label)
    : label_(std::move(label)), watched_(isatty(STDERR_FILENO) == 1), started_(steady_clock::now()) {}

Progress::~Progress() { finish(); }

void Progress::update(double fraction) {
  if (!watched_ || finished_ || steady_clock::now() - drawn_ < std::chrono::milliseconds(100)) return;
  draw(std::clamp(fraction, 0.0, 1.0));
}

void Progress::finish() {
  if (!watched_ || finished_) return;
  finished_ = true;
  draw(1.0);
  std::fputc('\n', stderr);
}

void Progress::draw(double fraction) {
  constexpr int kWidth = 32;
  drawn_ = steady_clock::now();
  const double elapsed_s = std::chrono::duration<double>(drawn_ - started_).count();
  const auto filled = static_cast<int>(fraction * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r%-22s [%s] %3.0f %%  %5.1f s", label_.c_str(), bar.c_str(), 100.0 * fraction,
               elapsed_s);
  std::fflush(stderr);
}

}  // namespace isobar::tools
