// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/html_page.hpp"

#include "tools/report/number_text.hpp"
#include "tools/web/inline_text.hpp"
#include "tools/web/page_files.hpp"

namespace isobar::report {

namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --ground: #fff; --panel: #fff; --raised: #f3f4f6; --ink: #1f2937; --muted: #4b5563;
  --line: #d1d5db; --soft-line: #e5e7eb; --strong-line: #6b7280; --error: #b91c1c; --accent: #c4185c; --map-ground: #f7f8fa;
  --map-rim: #fff; }
@media (prefers-color-scheme: dark) { :root { --ground: #0e1114; --panel: #161a1f; --raised: #1f252c; --ink: #e7ebef;
  --muted: #a3afbb; --line: #323b45; --soft-line: #272e36; --strong-line: #93a0ad; --error: #ff6369; --accent: #ff5c93;
  --map-ground: #0b0d10; --map-rim: #0b0d10; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink);
  font: 16px/1.55 system-ui, "Segoe UI", Roboto, "DejaVu Sans", Helvetica, Arial, sans-serif; }
main { max-width: 1104px; margin: 0 auto; padding: 40px 32px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 8px; letter-spacing: -0.01em; }
h2 { font-size: 20px; margin: 48px 0 6px; }
p { margin: 6px 0; max-width: 78ch; }
.lead { color: var(--muted); font-size: 17px; }
.command { margin: 16px 0 0; padding: 10px 14px; background: var(--raised); border-radius: 6px; font: 13.5px/1.5 ui-monospace,
  "DejaVu Sans Mono", Menlo, Consolas, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
.tiles { display: flex; flex-wrap: wrap; gap: 14px; margin: 26px 0 0; padding: 0; list-style: none; }
.tiles li { flex: 1 1 200px; border: 1px solid var(--line); border-radius: 8px; padding: 12px 16px; }
.tiles .label { font-size: 13.5px; color: var(--muted); }
.tiles .value { font-size: 26px; font-weight: 600; font-variant-numeric: tabular-nums; line-height: 1.35; }
.tiles .more { font-size: 13.5px; color: var(--muted); }
figure { margin: 14px 0 0; break-inside: avoid; }
.no-chart { color: var(--muted); background: var(--raised); border-radius: 6px; padding: 12px 16px; }
figcaption { font-size: 14px; color: var(--muted); margin-top: 4px; max-width: 92ch; }
.scroll, pre { overflow-x: auto; }
table { border-collapse: collapse; font-size: 14.5px; font-variant-numeric: tabular-nums; margin-top: 12px; }
th, td { padding: 5px 14px 5px 0; text-align: right; border-bottom: 1px solid var(--soft-line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid var(--strong-line); vertical-align: bottom; }
td.group { padding-top: 16px; font-weight: 700; color: var(--muted); border-bottom: 1px solid var(--line); }
td.unit { text-align: left; color: var(--muted); }
td.best { font-weight: 700; }
td.lost { color: var(--error); font-weight: 700; }
.notes li { margin: 3px 0; max-width: 92ch; }
dl { max-width: 92ch; font-size: 15px; } dt { font-weight: 600; margin-top: 10px; } dd { margin: 0; }
@media (max-width: 560px) { main { padding: 20px 14px 40px; } h1 { font-size: 24px; } .lead { font-size: 16px; }
  .tiles li { flex-basis: 44%; padding: 8px 10px; } .tiles .value { font-size: 20px; }
  th, td { padding-right: 10px; } th, td:first-child, td.unit { white-space: normal; } tr:has(td.unit) td:first-child { min-width: 130px; } }
@page { size: A4; margin: 14mm; }
@media print { main { padding: 0; max-width: none; } h2, .before-table { break-after: avoid; } body { font-size: 11pt; }
  table { font-size: 8pt; } th, td { padding: 3px 9px 3px 0; } th { white-space: normal; } .scroll { overflow: visible; }
  tr { break-inside: avoid; } .tiles { gap: 8px; } .tiles li { flex-basis: 22%; padding: 8px 10px; }
  .tiles .value { font-size: 20px; } }
)css";

std::string cell_html(const TableCell& cell) {
  std::string tag = "<td";
  if (!cell.css_class.empty()) tag += " class=\"" + cell.css_class + "\"";
  if (cell.columns > 1) tag += " colspan=\"" + std::to_string(cell.columns) + "\"";
  return tag + ">" + escaped(cell.text) + "</td>";
}

}  // namespace

std::string html_page(const std::string& title, const std::string& body, PageScript script) {
  const auto parts =
      web::inline_parts(script == PageScript::kReport ? web::InlinePage::kReport : web::InlinePage::kCharts);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" "
         "href=\"data:,\">\n<title>" +
         escaped(title) + "</title>\n<style>" + kStyle + (parts ? parts->style : "") +
         "</style>\n</head>\n<body>\n<main>\n" + body + "</main>\n" +
         (parts ? "<script>" + parts->script + "</script>\n" : "") + "</body>\n</html>\n";
}

std::string page_head(const std::string& title, const std::string& lead, const std::string& command) {
  std::string html = "<h1>" + escaped(title) + "</h1>\n";
  if (!lead.empty()) html += "<p class=\"lead\">" + escaped(lead) + "</p>\n";
  if (!command.empty()) html += "<div class=\"command\">" + escaped(command) + "</div>\n";
  return html;
}

std::string heading(const std::string& text) { return "<h2>" + escaped(text) + "</h2>\n"; }

std::string paragraph(const std::string& text) { return "<p>" + escaped(text) + "</p>\n"; }

std::string no_chart(const std::string& reason) {
  return "<p class=\"no-chart\">" + escaped(reason) + "</p>\n";
}

std::string chart_figure(const std::string& chart_json, const std::string& title,
                         const std::string& caption) {
  const bool has_page = !web::page_files().empty();
  const std::string place = has_page ? "This chart needs JavaScript." : web::kPicturesMissing;
  return "<figure>\n<div class=\"chart-place\" aria-label=\"" + escaped(title) + "\">" + no_chart(place) +
         "</div>\n<script type=\"application/json\" class=\"isobar-chart\">" + web::script_safe(chart_json) +
         "</script>\n<figcaption>" + escaped(caption) + "</figcaption>\n</figure>\n";
}

std::string bullet_list(const std::vector<std::string>& lines) {
  std::string html = "<ul class=\"notes\">\n";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>\n";
  return html + "</ul>\n";
}

std::string tile_row(const std::vector<Tile>& tiles) {
  std::string html = "<ul class=\"tiles\">\n";
  for (const Tile& tile : tiles) {
    html += "<li><div class=\"label\">" + escaped(tile.label) + "</div><div class=\"value\">" +
            escaped(tile.value) + "</div><div class=\"more\">" + escaped(tile.remark) + "</div></li>\n";
  }
  return html + "</ul>\n";
}

std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<TableCell>>& rows) {
  std::string html =
      "<div class=\"scroll\" role=\"region\" aria-label=\"Table\" tabindex=\"0\"><table>\n<thead><tr>";
  for (const std::string& title : head) html += "<th>" + escaped(title) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<TableCell>& row : rows) {
    html += "<tr>";
    for (const TableCell& cell : row) html += cell_html(cell);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace isobar::report
