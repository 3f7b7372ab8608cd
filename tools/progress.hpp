// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace isobar::tools {

/// A progress bar on stderr; silent when stderr is not a terminal.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param fraction 0 … 1; drawn at most ten times per second
  void update(double fraction);
  /// Draws the full bar and ends the line. The destructor calls it if needed.
  void finish();

 private:
  void draw(double fraction);

  std::string label_;
  bool watched_;
  bool finished_ = false;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace isobar::tools
