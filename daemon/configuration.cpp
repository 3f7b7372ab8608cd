// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>

#include "core/errors.hpp"
#include "daemon/graph.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/service.hpp"
#include "run/files/run_layout.hpp"

namespace isobar {
namespace {

namespace fs = std::filesystem;
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

/// Refuses folders that hold files of others, as the next start would. Those in use are not looked at.
/// @throws ConfigErrors
void check_folders(const Config& wanted, const Config& running, const KeyOrigins& origins) {
  Problems problems;
  const auto check = [&](const std::string& key, const std::string& folder, const std::string& used,
                         const char* own) {
    if (folder.empty() || folder == used) return;
    const auto origin = origins.find(key);
    const std::string place = origin == origins.end() ? "" : origin->second.place + ": ";
    problems.attempt([&] { files::refuse_foreign_folder(folder, own, place + key); });
  };
  check("output.directory", wanted.output.directory, running.output.directory, "");
  check("map.directory", wanted.map_files.directory, running.map_files.directory, "map.toml");
  problems.throw_if_any();
}

std::int64_t utc_s() { return static_cast<std::int64_t>(std::time(nullptr)); }

}  // namespace

Configuration::Configuration(const std::string& file, CommandLine command_line, const fs::path& state_folder)
    : file_(file),
      command_line_(std::move(command_line)),
      kept_file_(file.empty() || state_folder.empty() ? fs::path() : state_folder / kKeptConfigFile),
      accepted_(Clock::now()),
      accepted_utc_s_(utc_s()),
      watch_(file) {
  start();
  if (!file.empty() && !watch_.works()) {
    spdlog::warn("{}: the kernel refuses to watch its folder; only SIGHUP reloads it", file);
  }
}

std::string Configuration::name() const { return file_.empty() ? "" : config_identity(file_); }

void Configuration::start() {
  try {
    LoadedConfig loaded = file_.empty() ? LoadedConfig{} : load();
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    notes_ = std::move(loaded.notes);
    accepted_config_ = loaded.config;
    hash_ = config_hash(accepted_config_);
    if (const auto before = kept(); before && kept_hash_ == hash_) begin_at(before->since_s);
  } catch (const ConfigErrors& errors) {
    start_with_kept(errors);
  }
  running_ = accepted_config_;
  command_line_(running_);
}

void Configuration::start_with_kept(const ConfigErrors& errors) {
  const auto before = kept();
  if (!before) throw errors;
  accepted_config_ = before->config;
  hash_ = kept_hash_;
  begin_at(before->since_s);
  runs_kept_ = true;
  refuse(errors.all());
}

/// Goes on counting the age of a configuration that earlier runs had.
void Configuration::begin_at(std::int64_t since_s) {
  if (since_s <= 0) return;
  accepted_utc_s_ = since_s;
  age_before_s_ = std::max(0.0, static_cast<double>(utc_s() - since_s));
}

LoadedConfig Configuration::load() const {
  LoadedConfig loaded = load_layers(file_);
  Config wanted = loaded.config;
  command_line_(wanted);
  check_folders(wanted, running_, loaded.origins);
  return loaded;
}

/// The configuration in the state folder; says why it cannot be used.
std::optional<KeptConfig> Configuration::kept() {
  if (kept_file_.empty()) return std::nullopt;
  try {
    auto kept = read_kept_config(kept_file_, file_);
    if (kept) kept_hash_ = config_hash(kept->config);
    return kept;
  } catch (const ConfigError& error) {
    spdlog::warn("the kept configuration is not used: {}", error.what());
    return std::nullopt;
  }
}

// Only once the program runs with it: a start that fails leaves the former one.
void Configuration::keep() {
  if (kept_file_.empty() || kept_hash_ == hash_ || Clock::now() < next_keep_) return;
  next_keep_ = Clock::now() + std::chrono::minutes(1);
  try {
    keep_config(kept_file_, file_, {accepted_config_, accepted_utc_s_});
    kept_hash_ = hash_;
    next_keep_ = {};
    keep_failure_.clear();
  } catch (const Error& error) {
    if (keep_failure_ != error.what()) {
      spdlog::warn(
          "the configuration cannot be kept for a start with bad files: {}; trying again every minute",
          error.what());
    }
    keep_failure_ = error.what();
  }
}

void Configuration::poll(Graph& graph, Service& service) {
  keep();
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
    take(load(), graph);
  } catch (const ConfigErrors& errors) {
    refuse(errors.all());
  } catch (const std::exception& error) {
    refuse({error.what()});
  }
}

void Configuration::take(LoadedConfig loaded, Graph& graph) {
  const std::string hash = config_hash(loaded.config);
  const Config of_files = loaded.config;
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
  if (hash != hash_) {
    accepted_ = Clock::now();
    accepted_utc_s_ = utc_s();
    age_before_s_ = 0.0;
  }
  accepted_config_ = of_files;
  hash_ = hash;
  runs_kept_ = false;
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
  if (runs_kept_) {
    spdlog::warn(
        "configuration {} of an earlier run is in force, kept in {}; the files are taken as soon as they "
        "are right",
        hash_, kept_file_.string());
  } else {
    spdlog::warn("configuration {} stays in force", hash_);
  }
  last_refusal_ = problems;
}

std::string Configuration::status() const {
  if (!last_refusal_.empty()) {
    return fmt::format("configuration {} stays in force; refused: {}", hash_, last_refusal_.front());
  }
  const std::string waits = at_start_.empty() ? "" : "; takes effect at the next start: " + listed(at_start_);
  return fmt::format("configuration {} in force{}", hash_, waits);
}

double Configuration::age_s() const {
  return age_before_s_ + std::chrono::duration<double>(Clock::now() - accepted_).count();
}

void Configuration::fill(ipc::HealthReport& report) const {
  ipc::copy_text(hash_, report.status.configuration, sizeof report.status.configuration);
  const double age_s = this->age_s();
  add_entry(report, "configuration", last_refusal_.empty() ? HealthLevel::kOk : HealthLevel::kWarning,
            fmt::format("hash {}, for {:.0f} s, {} reloads refused{}", hash_, age_s, refused_,
                        runs_kept_ ? "; kept from an earlier run, as the files are bad" : ""),
            age_s);
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
