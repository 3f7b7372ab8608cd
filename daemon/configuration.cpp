// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "config/problems.hpp"
#include "daemon/graph.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/service.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;

/// "a, b, c and 4 more"
std::string listed(const std::vector<std::string>& keys) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < keys.size() && i < kMost; ++i) text += (i == 0 ? "" : ", ") + keys[i];
  return keys.size() > kMost ? text + fmt::format(" and {} more", keys.size() - kMost) : text;
}

/// "; at once: a; by a new stage: b; at the next start: c"
std::string effects(const ConfigChange& change) {
  std::string text;
  if (!change.live.empty()) text += "; at once: " + listed(change.live);
  if (!change.stage.empty()) text += "; by a new stage: " + listed(change.stage);
  if (!change.at_start.empty()) text += "; takes effect at the next start: " + listed(change.at_start);
  return text;
}

}  // namespace

Configuration::Configuration(const std::string& file, CommandLine command_line)
    : file_(file), command_line_(std::move(command_line)), accepted_(Clock::now()), watch_(file) {
  LoadedConfig loaded;
  if (!file.empty()) loaded = load_layers(file);
  hash_ = config_hash(loaded.config);
  for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
  notes_ = loaded.notes;
  command_line_(loaded.config);
  running_ = loaded.config;
  if (!file.empty() && !watch_.works()) {
    spdlog::warn("{}: the kernel refuses to watch its folder; only SIGHUP reloads it", file);
  }
}

void Configuration::poll(Graph& graph, Service& service) {
  const bool asked = service.take_reload_request();
  const bool changed = !file_.empty() && watch_.changed(Clock::now());
  if (!asked && !changed) return;
  service.reloading();
  if (file_.empty()) {
    spdlog::info("configuration: defaults, as no --config was given; nothing to reload");
  } else {
    reload(graph);
  }
  service.ready(status());
}

void Configuration::reload(Graph& graph) {
  try {
    take(load_layers(file_), graph);
  } catch (const ConfigErrors& errors) {
    refuse(errors.all());
  } catch (const std::exception& error) {
    refuse({error.what()});
  }
}

void Configuration::take(LoadedConfig loaded, Graph& graph) {
  const std::string hash = config_hash(loaded.config);
  command_line_(loaded.config);
  ConfigChange change = change_to(
      running_, loaded.config, [&graph](const Setting& setting) { return graph.apply_of(setting); }, file_);
  if (!change.nothing_now()) graph.apply(change);
  running_ = std::move(change.running);
  for (const std::string& note : loaded.notes) {
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) spdlog::warn("{}", note);
  }
  notes_ = std::move(loaded.notes);
  if (hash != hash_ || change.at_start != at_start_ || !last_refusal_.empty()) {
    spdlog::info("configuration {} in force{}", hash, effects(change));
  }
  if (hash != hash_) accepted_ = Clock::now();
  hash_ = hash;
  at_start_ = std::move(change.at_start);
  last_refusal_.clear();
}

// The same problems are logged once, however often the files are touched.
void Configuration::refuse(const std::vector<std::string>& problems) {
  ++refused_;
  if (problems == last_refusal_) return;
  constexpr std::size_t kMostLines = 20;
  for (std::size_t i = 0; i < problems.size() && i < kMostLines; ++i) {
    spdlog::error("configuration refused: {}", problems[i]);
  }
  if (problems.size() > kMostLines) spdlog::error("… and {} more", problems.size() - kMostLines);
  spdlog::warn("configuration {} stays in force", hash_);
  last_refusal_ = problems;
}

std::string Configuration::status() const {
  if (!last_refusal_.empty()) {
    return fmt::format("configuration {} stays in force; refused: {}", hash_, last_refusal_.front());
  }
  const std::string waits = at_start_.empty() ? "" : "; takes effect at the next start: " + listed(at_start_);
  return fmt::format("configuration {} in force{}", hash_, waits);
}

void Configuration::fill(ipc::HealthReport& report) const {
  ipc::copy_text(hash_, report.status.configuration, sizeof report.status.configuration);
  const double age_s = std::chrono::duration<double>(Clock::now() - accepted_).count();
  add_entry(report, "configuration", last_refusal_.empty() ? HealthLevel::kOk : HealthLevel::kWarning,
            fmt::format("hash {}, for {:.0f} s, {} reloads refused", hash_, age_s, refused_), age_s);
  if (!last_refusal_.empty()) {
    add_entry(report, "configuration/refused", HealthLevel::kWarning, last_refusal_.front(),
              static_cast<double>(last_refusal_.size()));
  }
  if (!at_start_.empty()) {
    add_entry(report, "configuration/next_start", HealthLevel::kOk,
              "takes effect at the next start: " + listed(at_start_), static_cast<double>(at_start_.size()));
  }
}

}  // namespace isobar
