// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/page_files.hpp"

#include <array>

#if ISOBAR_WITH_PAGE
// Begin and end of each file, see embedded_page.S.in.
extern "C" {
extern const char isobar_page_html[], isobar_page_html_end[];  // NOLINT(modernize-avoid-c-arrays)
extern const char isobar_page_js[], isobar_page_js_end[];      // NOLINT(modernize-avoid-c-arrays)
extern const char isobar_page_css[], isobar_page_css_end[];    // NOLINT(modernize-avoid-c-arrays)
extern const char isobar_page_icon[], isobar_page_icon_end[];  // NOLINT(modernize-avoid-c-arrays)
}
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

}  // namespace isobar::web
