// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/page_files.hpp"

#include <array>

#include "tools/web/inline_text.hpp"

#if ISOBAR_WITH_PAGE
// Begin and end of each file, see embedded_page.S.in: names of the assembler, arrays of unknown length.
// NOLINTBEGIN(modernize-avoid-c-arrays, readability-identifier-naming)
extern "C" {
extern const char isobar_page_html[], isobar_page_html_end[];
extern const char isobar_page_js[], isobar_page_js_end[];
extern const char isobar_page_css[], isobar_page_css_end[];
extern const char isobar_page_icon[], isobar_page_icon_end[];
extern const char isobar_page_charts_js[], isobar_page_charts_js_end[];
extern const char isobar_page_charts_css[], isobar_page_charts_css_end[];
extern const char isobar_page_report_js[], isobar_page_report_js_end[];
extern const char isobar_page_report_css[], isobar_page_report_css_end[];
}
// NOLINTEND(modernize-avoid-c-arrays, readability-identifier-naming)
#endif

namespace isobar::web {

std::span<const PageFile> page_files() {
#if ISOBAR_WITH_PAGE
  static const std::array<PageFile, 4> files{
      {{"/", "text/html; charset=utf-8", {isobar_page_html, isobar_page_html_end}},
       {"/page.js", "text/javascript; charset=utf-8", {isobar_page_js, isobar_page_js_end}},
       {"/page.css", "text/css; charset=utf-8", {isobar_page_css, isobar_page_css_end}},
       {"/icon.svg", "image/svg+xml", {isobar_page_icon, isobar_page_icon_end}}}};
  return files;
#else
  return {};
#endif
}

std::optional<InlineParts> inline_parts(InlinePage page) {
#if ISOBAR_WITH_PAGE
  using View = std::string_view;
  const auto unpack = [](View script, View style) { return InlineParts{unpacked(script), unpacked(style)}; };
  switch (page) {
    case InlinePage::kRun:
      return unpack({isobar_page_js, isobar_page_js_end}, {isobar_page_css, isobar_page_css_end});
    case InlinePage::kCharts:
      return unpack({isobar_page_charts_js, isobar_page_charts_js_end},
                    {isobar_page_charts_css, isobar_page_charts_css_end});
    case InlinePage::kReport:
      return unpack({isobar_page_report_js, isobar_page_report_js_end},
                    {isobar_page_report_css, isobar_page_report_css_end});
  }
  return std::nullopt;
#else
  (void)page;
  return std::nullopt;
#endif
}

}  // namespace isobar::web
