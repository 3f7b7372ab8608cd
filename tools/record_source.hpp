// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <optional>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar::tools {

/// A child process that attaches to isobard and writes its inputs to a pipe as an input log
/// (run/recording/input_log.hpp). A process of its own, because a process can attach to shared memory only
/// once: after a restart of isobard a new child attaches, and the recorder keeps its open files.
class RecordSource {
 public:
  /// Exit codes of the child.
  static constexpr int kBrokerEnded = 3;   ///< isobard has ended, or is silent
  static constexpr int kOtherVersion = 4;  ///< isobard does not describe itself: it is another version

  static constexpr int kRefused = 5;  ///< this user may not attach; the child has printed why

  /// Forks the child. The calling process must not have attached, and must have no other threads.
  /// @param quiet the child prints no errors: the same ones were printed before
  /// @throws ServiceError when the system refuses a pipe or a process
  explicit RecordSource(bool quiet);
  ~RecordSource();  ///< kills the child if it still runs
  RecordSource(const RecordSource&) = delete;
  RecordSource& operator=(const RecordSource&) = delete;

  /// End of the pipe that delivers the log; end of file: the child has ended.
  [[nodiscard]] int descriptor() const { return log_.get(); }
  /// Asks the child to hand over the inputs that are waiting, and to end.
  void stop();
  /// After the end of file: the child's exit code; 128 + signal number if a signal ended it.
  int exit_code();

 private:
  FileDescriptor log_;
  pid_t child_ = -1;
};

}  // namespace isobar::tools
