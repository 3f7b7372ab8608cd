// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace isobar {

/// Directs spdlog's default logger to the systemd journal, with priorities, where
/// this process's stderr is the journal (JOURNAL_STREAM in systemd.exec(5));
/// otherwise to stderr, each line with time, program and level.
/// @param program the journal's SYSLOG_IDENTIFIER, such as "isobard"
void set_up_logging(const std::string& program);

}  // namespace isobar
