// SPDX-License-Identifier: BSD-3-Clause
// The look that all reports share: one HTML page that opens without a network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace isobar::report {

/// The script of a page: kCharts draws its charts; kReport the parts of report_data.hpp, too.
enum class PageScript : std::uint8_t { kCharts, kReport };

/// The whole page around `body`, which is HTML; `title` is text. Without a script where the program was built without
/// npm: chart_figure() then says so.
std::string html_page(const std::string& title, const std::string& body,
                      PageScript script = PageScript::kCharts);

// All functions below take plain text and return HTML.

/// Top of the page: title, a paragraph below it (may be empty), and the command that makes the page again
/// (may be empty).
std::string page_head(const std::string& title, const std::string& lead, const std::string& command);
std::string heading(const std::string& text);
std::string paragraph(const std::string& text);
/// What stands in the place of a chart that is not drawn.
std::string no_chart(const std::string& reason);
/// A chart that the page's script draws from the JSON of chart_json(); `title` is read by screen readers.
std::string chart_figure(const std::string& chart_json, const std::string& title, const std::string& caption);
std::string bullet_list(const std::vector<std::string>& lines);

/// A figure in large type, with its name above and a remark below.
struct Tile {
  std::string label;
  std::string value;
  std::string remark;
};
std::string tile_row(const std::vector<Tile>& tiles);

struct TableCell {
  std::string text;
  std::string css_class{};  ///< "best", "lost", "unit", "group" or empty
  std::size_t columns = 1;  ///< columns that the cell spans
};
std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<TableCell>>& rows);

}  // namespace isobar::report
