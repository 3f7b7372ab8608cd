// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "run/tile_store/file_descriptor.hpp"

namespace isobar {

/// A sleep on the monotonic clock that another thread can end. Allocates nothing after construction.
class StoppableTimer {
 public:
  /// @throws ServiceError when the kernel refuses a descriptor
  StoppableTimer();

  /// Sleeps for `duration_ns`, but at least 0.5 ms: an owner that falls behind its own period must not keep a
  /// core from threads of lower priority. One thread.
  /// @param file_descriptor ends the sleep when it is readable; -1: none
  /// @return false once stopped
  [[nodiscard]] bool sleep_for(std::int64_t duration_ns, int file_descriptor = -1) noexcept;
  /// Ends the current sleep and all later ones. Any thread.
  void stop() noexcept;

 private:
  FileDescriptor timer_;
  FileDescriptor stop_event_;
};

}  // namespace isobar
