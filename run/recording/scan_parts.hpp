// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "run/recording/cloud_file.hpp"
#include "run/recording/input_log.hpp"

namespace isobar::recording {

/// Puts the scans of an input log together again, as clouds for a recording.
class ScanParts {
 public:
  /// @param entry of the kind kScanPart
  /// @return the cloud of a scan whose last part it is, valid until the next call; else nullptr
  const CloudRecord* add(const LogEntry& entry);
  /// Scans of which a part is missing.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  CloudRecord cloud_;
  std::uint32_t points_ = 0;  ///< of the scan that is put together
  bool is_open_ = false;      ///< parts of it are still to come
  std::uint64_t lost_ = 0;
};

}  // namespace isobar::recording
