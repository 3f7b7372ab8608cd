// SPDX-License-Identifier: BSD-3-Clause
// The log of all programs: the same text everywhere, with fields in the journal and a head on a terminal.
#pragma once

#include <string>

#include "daemon/level_changes.hpp"

namespace isobar {

/// Directs spdlog's default logger to the systemd journal, with priority and SYSLOG_IDENTIFIER as fields,
/// where this process's stderr is the journal; otherwise to stderr, each line with time, program and level.
/// @param program the journal's SYSLOG_IDENTIFIER, such as "isobard"
void set_up_logging(const std::string& program);

/// Lines of programs that do not name the logging library.
void log_info(const std::string& text);
void log_warning(const std::string& text);

/// Logs a change of a health entry at the level of its content: an error at 3 (err), a warning and data that
/// no longer comes at 4 (warning), the rest at 6 (info). In the journal with the fields ISOBAR_ENTRY,
/// ISOBAR_LEVEL and ISOBAR_VALUE.
void log_change(const LevelChange& change);

}  // namespace isobar
