// SPDX-License-Identifier: BSD-3-Clause
// The detectors of contradictions over a whole recording: before its replay, and for `isobar check`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "core/contradictions/clock_verdicts.hpp"
#include "core/contradictions/finding.hpp"
#include "run/recording/manifest.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {

/// What a recording says about itself.
struct RecordingCheck {
  Findings findings;
  UsableSensors usable;
  AllStreamTimes times;  ///< by CheckedSensor, robot clock; the lidar's are scans
  std::string base_clock;
  std::vector<std::string> warnings;     ///< of the manifest
  std::vector<std::string> notes;        ///< what is no evidence, but worth a look
  std::string silent_lidar;              ///< why no scan was decoded; empty: one was, or there is no lidar
  std::vector<recording::Count> counts;  ///< of the reader
};

/// Reads the recording once, with the mounts of `used` (with_sensors_of()). Of the pipeline only the decoder runs: 1.2 ms
/// a scan of a VLP-16.
/// @param progress called with 0 … 1
/// @throws DataError for a recording that cannot be read
RecordingCheck check_recording(const std::filesystem::path& recording, const Config& used,
                               const std::function<void(double)>& progress);

/// `manifest` without the sensors that are not used.
recording::Manifest without_unusable(recording::Manifest manifest, const UsableSensors& usable);
/// True for events of a sensor that is used.
bool is_used(recording::EventKind kind, const UsableSensors& usable);

/// Refuses a recording whose IMU has no time in common with its lidar: one of the clocks, or one of the files, is wrong, and
/// which one is not known.
/// @throws DataError
void refuse_clocks_apart(const RecordingCheck& check, const std::filesystem::path& recording);

/// The findings and what the run leaves out, a sentence each.
std::vector<std::string> contradiction_texts(const RecordingCheck& check);

}  // namespace isobar
