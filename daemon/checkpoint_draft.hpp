// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "core/estimates.hpp"
#include "run/files/checkpoint.hpp"

namespace isobar {

/// Collects the next checkpoint from the poses of a run. One thread.
class CheckpointDraft {
 public:
  /// @param stations names of the base stations that the run listens to
  explicit CheckpointDraft(files::StationNames stations = {}) : stations_(std::move(stations)) {}

  /// Takes a pose, in order of time. One before the place is known is none to go on from.
  void note(const PoseEstimate& pose) noexcept;
  /// A pose to go on from has come since the last written().
  [[nodiscard]] bool due() const noexcept { return due_; }
  /// The checkpoint at `now_ns` with the present height datum.
  [[nodiscard]] files::Checkpoint at(std::int64_t now_ns, const HeightDatum& datum) const;
  /// The checkpoint has been written.
  void written() noexcept { due_ = false; }

 private:
  files::StationNames stations_;
  PoseEstimate last_pose_;
  files::Checkpoint checkpoint_;
  bool due_ = false;
};

}  // namespace isobar
