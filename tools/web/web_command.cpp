// SPDX-License-Identifier: BSD-3-Clause
// `isobar web`: the page of the running isobard, of a run, or of a recording. A process of its own: no request ever
// reaches the estimator.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "daemon/service.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "ipc/service_view.hpp"
#include "run/files/run_layout.hpp"
#include "run/recording/manifest.hpp"
#include "tools/commands.hpp"
#include "tools/progress.hpp"
#include "tools/status/hang_limit.hpp"
#include "tools/status/health_reader.hpp"
#include "tools/subcommand.hpp"
#include "tools/web/file_view.hpp"
#include "tools/web/live_reader.hpp"
#include "tools/web/page_files.hpp"
#include "tools/web/view_json.hpp"
#include "tools/web/web_server.hpp"

namespace isobar::tools {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using web::LiveState;
using web::MapTiles;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr unsigned kWebAttachLimitS = 5;

struct WebOptions {
  fs::path folder;
  web::WebAddress where;
  std::vector<std::string> hosts;
  fs::path token_file;
};

/// Another number in each process, so that a page never mixes maps of two.
std::uint32_t epoch_of_process() { return static_cast<std::uint32_t>(monotonic_ns() >> 20U) | 1U; }

web::HostCheck host_check(const WebOptions& options) {
  std::vector<std::string> names = web::names_of_this_machine();
  names.insert(names.end(), options.hosts.begin(), options.hosts.end());
  return web::HostCheck(names);
}

std::string url_of(const web::WebAddress& where) {
  const bool is_ipv6 = where.address.find(':') != std::string::npos;
  const std::string host = where.address == "0.0.0.0" || where.address == "::" ? "localhost"
                           : is_ipv6                                           ? "[" + where.address + "]"
                                                                               : where.address;
  return "http://" + host + ":" + std::to_string(where.port) + "/";
}

void say_where(const std::string& what, const WebOptions& options) {
  std::printf("%s: %s\n", what.c_str(), url_of(options.where).c_str());
}

/// Serves what has been read until a signal comes.
void serve_folder(const WebOptions& options) {
  if (!options.token_file.empty()) throw UsageError("--token-file is for a running isobard only");
  if (!fs::exists(options.folder)) throw DataError(options.folder.string() + ": does not exist");
  Service service;
  MapTiles map(epoch_of_process());
  web::FileView view;
  if (fs::exists(options.folder / recording::kManifestFile)) {
    Progress progress("reading " + options.folder.filename().string());
    view = web::read_recording(options.folder, [&](double part) { progress.update(part); });
  } else if (files::newest_session(options.folder) > 0) {
    view = web::read_run(options.folder, map);
  } else {
    throw DataError(web::not_shown(options.folder));
  }
  web::Served served;
  served.view = [&view] { return view.json; };
  served.map = &map;
  served.hosts = host_check(options);
  const web::WebServer server(options.where, std::move(served));
  say_where(view.summary, options);
  while (service.wait_for(1s)) {
  }
}

/// /api/view of a running isobard.
std::string live_view(const LiveState& live, const MapTiles& map, bool can_act) {
  const std::vector<web::PoseRow> history = live.history();
  const std::int64_t origin_ns = history.empty() ? RobotClock::now_ns() : history.front().stamp_ns;
  std::string machine = web::names_of_this_machine().empty() ? "robot" : web::names_of_this_machine().front();
  Json json = web::empty_view("live", machine, origin_ns);
  json["can_act"] = can_act;
  json["poses"] = web::poses_json(history, origin_ns);
  json["map"] = web::map_json(map.state());
  if (const std::string settings = live.newest(web::Topic::kSettings); !settings.empty()) {
    json["settings"] = Json::parse(settings, nullptr, false);
  }
  return web::text_of(json);
}

/// Attaches to isobard.
/// @return null while it does not run
std::unique_ptr<web::LiveReader> attach(LiveState& live, MapTiles& map, web::ActionDesk& desk) {
  try {
    const HangLimit limit(kWebAttachLimitS, HangLimit::kWait);
    return std::make_unique<web::LiveReader>(live, map, desk);
  } catch (const ServiceError& error) {
    const std::string text = std::string(error.what()) + ". This page waits for it.";
    live.put(web::Topic::kLink, web::text_of(Json{{"ok", false}, {"text", text}}));
    return nullptr;
  }
}

/// Serves the running isobard until a signal comes. Where it ends, this program begins anew: a process attaches once.
void serve_live(const WebOptions& options) {
  ipc::enter_service_view();
  std::optional<web::Token> token;
  if (!options.token_file.empty()) token = web::Token::read(options.token_file);
  Service service;  // first, so that every thread inherits the blocked signals
  LiveState live;
  MapTiles map(epoch_of_process());
  web::ActionDesk desk;
  web::Served served;
  served.view = [&] { return live_view(live, map, token.has_value()); };
  served.map = &map;
  served.live = &live;
  served.actions = token ? &desk : nullptr;
  served.token = token ? &*token : nullptr;
  served.hosts = host_check(options);
  std::optional<web::WebServer> server(std::in_place, options.where, std::move(served));
  ipc::set_fatal_action(&run_again);
  say_where("the running isobard", options);
  service.ready("page on " + url_of(options.where));
  std::unique_ptr<web::LiveReader> reader;
  while (service.wait_for(reader ? 100ms : 500ms)) {
    service.feed_watchdog();
    if (!reader) reader = attach(live, map, desk);
    if (!reader) continue;
    reader->poll(server->viewers());
    if (!reader->alive()) run_again();
  }
  server.reset();
  end_attached(0);
}

void run_web(const WebOptions& options) {
  if (web::page_files().empty()) throw ServiceError(web::kPageMissing);
  if (options.folder.empty()) {
    serve_live(options);
  } else {
    serve_folder(options);
  }
}

}  // namespace

void add_web_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<WebOptions>(
      app, "web", "Serve a page that shows the running isobard, a run or a recording, until a signal comes",
      run_web);
  command.add_option("DIR", options.folder,
                     "folder of a run or of a recording; default: the running isobard");
  command
      .add_option("--listen", options.where.address,
                  "address to listen on; 0.0.0.0: all. Anybody who reaches it may look")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command.add_option("--port", options.where.port, "TCP port")
      ->check(CLI::Range(1, 65'535))
      ->capture_default_str();
  command
      .add_option("--host", options.hosts,
                  "name under which this machine is called in browsers, besides its own and its addresses")
      ->type_name("NAME")
      ->take_all();
  command
      .add_option("--token-file", options.token_file,
                  "file with the token that lets its holder save the black box and tell where the robot is; "
                  "default: the page is read-only")
      ->type_name("FILE");
  command.add_option("--viewers", options.where.most_viewers, "most pages that are open at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

}  // namespace isobar::tools
