// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "run/recording/recording_writer.hpp"
#include "tools/import/import_plan.hpp"

namespace isobar::tools {

/// Writes the recording of a plan.
/// @param notes receives what was left out
/// @param progress called with 0 … 1
/// @throws DataError when a file cannot be written, or the source has become unreadable
void write_messages(const ImportRequest& request, const ImportPlan& plan, recording::RecordingWriter& writer,
                    std::vector<std::string>& notes, const std::function<void(double)>& progress);

}  // namespace isobar::tools
