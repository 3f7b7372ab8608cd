// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/provenance.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>

#include "config/config_io.hpp"
#include "config/settings_by_key.hpp"
#include "core/errors.hpp"
#include "core/version.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "tools/report/html_page.hpp"

namespace isobar::report {

namespace {

namespace fs = std::filesystem;
using Values = std::map<std::string, std::string>;

/// "model name" of the processor; empty where the kernel tells none.
std::string processor_name() {
  std::ifstream lines("/proc/cpuinfo");
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t begin = line.find_first_not_of(": \t", line.find(':'));
    return begin == std::string::npos ? std::string() : line.substr(begin) + ", ";
  }
  return {};
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
  return text;
}

std::optional<Values> settings_of(const evaluation::EvaluatedMethod& method) {
  const fs::path folder = fs::is_directory(method.source) ? method.source : method.source.parent_path();
  const fs::path file = folder / files::kSettingsFile;
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    return settings_by_key(parse_config(files::read_text_file(file), file.string()));
  } catch (const Error&) {
    return std::nullopt;  // of another version of Isobar: the report is about the poses
  }
}

}  // namespace

std::string provenance_line() {
  const unsigned cores = std::thread::hardware_concurrency();
  return version_line("isobar") + ", " + processor_name() + std::to_string(cores) +
         (cores == 1 ? " core, " : " cores, ") + utc_now();
}

std::vector<DifferingSetting> differing_settings(const evaluation::EvaluatedRun& run) {
  std::vector<std::optional<Values>> all;
  std::set<std::string> keys;
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    all.push_back(settings_of(method));
    if (!all.back()) continue;
    for (const auto& [key, value] : *all.back()) keys.insert(key);
  }
  std::vector<DifferingSetting> differing;
  for (const std::string& key : keys) {
    DifferingSetting setting{key, {}};
    std::set<std::string> distinct;
    for (const std::optional<Values>& values : all) {
      const auto found = values ? values->find(key) : Values::const_iterator();
      setting.values.push_back(values && found != values->end() ? found->second : "");
      if (!setting.values.back().empty()) distinct.insert(setting.values.back());
    }
    if (distinct.size() > 1) differing.push_back(std::move(setting));
  }
  return differing;
}

std::string settings_section(const evaluation::EvaluatedRun& run) {
  const std::vector<DifferingSetting> differing = differing_settings(run);
  if (differing.empty()) return {};
  std::vector<std::string> head{"setting"};
  for (const evaluation::EvaluatedMethod& method : run.methods)
    head.push_back(evaluation::display_name(method.name));
  std::vector<std::vector<TableCell>> rows;
  for (const DifferingSetting& setting : differing) {
    std::vector<TableCell> row{{setting.key}};
    for (const std::string& value : setting.values) row.push_back({value.empty() ? "\u2013" : value});
    rows.push_back(std::move(row));
  }
  return heading("Settings that differ") + html_table(head, rows);
}

}  // namespace isobar::report
