// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isobar::ipc {

/// Silences the library, its log and std::cerr (to which it alone writes in these programs), and installs this
/// program's error handler, for the rest of the process. Call it before any other use of the library; later
/// calls do nothing.
void prepare_library();

}  // namespace isobar::ipc
