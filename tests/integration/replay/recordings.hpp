// SPDX-License-Identifier: BSD-3-Clause
// Recordings for tests of the whole pipeline: a simulated one, and copies of it with faults.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "daemon/replay.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/recording_writer.hpp"

namespace isobar::test {

/// The first 14 s of a tracked robot's drive (scenario stairs-demo, seed 3), simulated once a process.
const std::filesystem::path& short_drive();

/// New folder below the system's temporary one, removed when the process ends.
std::filesystem::path fresh_folder(const std::string& name);

/// Copies `from` event by event. `change_manifest` may remove sensors; `copy_event` writes each event, with
/// or without changes.
using CopyEvent = std::function<void(const recording::Event&, recording::RecordingWriter&)>;
std::filesystem::path copy_with(const std::filesystem::path& from, const std::string& name,
                                const std::function<void(recording::Manifest&)>& change_manifest,
                                const CopyEvent& copy_event);

/// Writes the event unchanged, if the writer's manifest has its sensor.
void write_event(const recording::Event& event, const recording::Manifest& manifest,
                 recording::RecordingWriter& writer);

/// Replays with the defaults; `out` gets the folder of the run.
ReplaySummary run(const std::filesystem::path& recording, std::filesystem::path& out,
                  Method method = Method::k3Dof);

/// Count of that name, 0 if there is none.
std::uint64_t count_of(const ReplaySummary& summary, const std::string& name);

/// Largest distance [m] between the trajectory of a run and the recording's reference, both from their start.
double largest_error_m(const std::filesystem::path& recording, const std::filesystem::path& out);

std::string bytes_of(const std::filesystem::path& file);

}  // namespace isobar::test
