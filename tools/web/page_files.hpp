// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
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

/// What a report says in the place of a picture where there is no page.
inline constexpr const char* kPicturesMissing =
    "This picture needs the page, which the isobar that wrote this report was built without.";

/// The files of the page; none when the program was built without npm.
[[nodiscard]] std::span<const PageFile> page_files();

/// What a file that holds its own data needs: the page of `isobar web`, the charts of a report (page/src/charts.ts), or
/// its charts and its map (page/src/report.ts).
struct InlineParts {
  std::string script;
  std::string style;
};
enum class InlinePage : std::uint8_t { kRun, kCharts, kReport };

/// Empty when the program was built without npm.
[[nodiscard]] std::optional<InlineParts> inline_parts(InlinePage page);

}  // namespace isobar::web
