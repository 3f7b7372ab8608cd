// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace isobar::web {

/// A file of the page, compressed with gzip, as it stands in the program.
struct PageFile {
  std::string_view path;  ///< of the request, "/page.js"
  std::string_view type;  ///< media type
  std::string_view gzip;  ///< its bytes
};

/// What is said where there is no page.
inline constexpr const char* kPageMissing =
    "isobar was built without its page: install nodejs and npm (tools/install build), configure and build "
    "again";

/// The files of the page; none when the program was built without npm.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace isobar::web
