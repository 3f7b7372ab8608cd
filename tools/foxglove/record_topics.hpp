// SPDX-License-Identifier: BSD-3-Clause
// `isobar record --mcap`: the live topics of isobar-dds in a file that Foxglove opens.
#pragma once

#include <filesystem>

#include "tools/dds_options.hpp"

namespace isobar::tools {

struct TopicRecording {
  std::filesystem::path file;   ///< created, or replaced when it is complete; until then FILE.part
  double duration_s = 0.0;      ///< 0: until SIGINT or SIGTERM
  double min_free_bytes = 0.0;  ///< free space at which the recording ends
  DdsOptions dds;
};

/// Records until the time is over, a signal comes or the disk has too little room; what was written is complete then.
/// @throws ServiceError when DDS or the file cannot be used, no message comes within 10 s, or the disk ends the recording
void record_topics(const TopicRecording& wanted);

}  // namespace isobar::tools
