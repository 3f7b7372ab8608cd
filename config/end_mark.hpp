// SPDX-License-Identifier: BSD-3-Clause
// End mark of a configuration file: by its last line a file shows that it is whole. A file cut anywhere is
// often valid TOML ("port = 2368" cut to "port = 23"), so that nothing else shows it.
#pragma once

#include <string>
#include <string_view>

namespace isobar {

/// The comment line at the top that announces the end mark. Only files with this line need one.
inline constexpr std::string_view kEndMarkAnnouncement =
    "# Whole only with the last line: # end of configuration";
/// The last line; may be followed by " sha256=HEX", the checksum of all bytes before that line.
inline constexpr std::string_view kEndMark = "# end of configuration";

/// `text` between announcement and end mark.
std::string with_end_mark(std::string_view text);

/// `text` between announcement and end mark with the checksum. Marks that it already has are replaced.
std::string with_checksum(std::string_view text);

/// Checks announcement, end mark and checksum.
/// @return "line N: rule" … as a place-free rule; empty: whole, or without announcement
std::string broken_end_mark(std::string_view text);

}  // namespace isobar
