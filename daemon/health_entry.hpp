// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "ipc/topics.hpp"

namespace isobar {

/// Adds an entry to the report. A full report counts the entry as lost, in an entry of its own.
inline void add_entry(ipc::HealthReport& report, std::string_view name, ipc::HealthLevel level,
                      std::string_view message, double value) noexcept {
  static_cast<void>(report.add(name, level, message, value));
}

}  // namespace isobar
