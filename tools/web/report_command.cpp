// SPDX-License-Identifier: BSD-3-Clause
// `isobar report`: the page of `isobar web` for one run or recording as a file that holds its data.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/errors.hpp"
#include "run/files/run_layout.hpp"
#include "run/recording/manifest.hpp"
#include "tools/commands.hpp"
#include "tools/output_option.hpp"
#include "tools/progress.hpp"
#include "tools/subcommand.hpp"
#include "tools/web/file_view.hpp"
#include "tools/web/inline_text.hpp"
#include "tools/web/page_files.hpp"

namespace isobar::tools {

namespace {

// Points of the map in the file, 11 bytes each.
constexpr std::size_t kMostMapPoints = 1'000'000;

struct ReportOptions {
  std::filesystem::path folder;
  std::filesystem::path out;
};

std::string page_of(const web::FileView& view, const web::MapTiles& map, const web::InlineParts& parts) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"dark light\">\n<title>Isobar</title>\n<style>" +
      parts.style +
      "</style>\n</head>\n<body><noscript><p class=\"first\">This page needs JavaScript.</p></noscript>\n";
  html +=
      "<script type=\"application/json\" id=\"isobar-view\">" + web::script_safe(view.json) + "</script>\n";
  if (map.state().points > 0) {
    html += "<script type=\"text/plain\" id=\"isobar-map\">" +
            web::base64(map.changes_since(0, 0, std::numeric_limits<std::size_t>::max())) + "</script>\n";
  }
  return html + "<script>" + parts.script + "</script>\n</body>\n</html>\n";
}

void run_report(const ReportOptions& options) {
  const auto parts = web::inline_parts(web::InlinePage::kRun);
  if (!parts) throw ServiceError(web::kPageMissing);
  require_path(options.folder, "the folder of a run, or a recording");
  const bool is_recording = std::filesystem::exists(options.folder / recording::kManifestFile);
  if (!is_recording && files::newest_session(options.folder) == 0)
    throw DataError(web::not_shown(options.folder));
  Progress progress("reading");
  web::MapTiles map(1);
  web::FileView view = is_recording
                           ? web::read_recording(options.folder, [&](double part) { progress.update(part); })
                           : web::read_run(options.folder, map);
  progress.finish();
  map.thin_to(kMostMapPoints);
  std::printf("%s\n", view.summary.c_str());
  write_output(options.out.empty() ? beside(options.folder, ".html") : options.out,
               page_of(view, map, *parts));
}

}  // namespace

void add_report_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<ReportOptions>(
      app, "report", "A run or a recording as one page to open or send: path, heights, map, health",
      run_report);
  command.add_option("FOLDER", options.folder, "folder of a run, or a recording")->required();
  command
      .add_option("--out", options.out,
                  "HTML file, replaced if it exists; it opens without a network (default: FOLDER.html)")
      ->check(written_as({".html", ".htm"}));
}

}  // namespace isobar::tools
