// SPDX-License-Identifier: BSD-3-Clause
// The configuration in force of a running isobard: reloads it, keeps the last good one, tells about it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/config_change.hpp"
#include "config/config_layer.hpp"
#include "daemon/config_watch.hpp"
#include "ipc/topics.hpp"

namespace isobar {

class Graph;
class Service;

/// What the command line sets over the files.
using CommandLine = std::function<void(Config&)>;

/// The configuration in force. A changed file is validated as a whole, with all other files; it then takes
/// effect key by key (Apply), or is refused and changes nothing. Main thread.
class Configuration {
 public:
  using Clock = std::chrono::steady_clock;

  /// Loads the files, or takes the defaults where `file` is empty.
  /// @throws ConfigErrors as load_layers()
  Configuration(const std::string& file, CommandLine command_line);

  [[nodiscard]] const Config& config() const { return running_; }

  /// Call every tick of the supervise loop: reloads after SIGHUP and after a change of the files.
  void poll(Graph& graph, Service& service);

  /// Adds the entries "configuration", "configuration/refused" and "configuration/next_start".
  void fill(ipc::HealthReport& report) const;

 private:
  void reload(Graph& graph);
  void take(LoadedConfig loaded, Graph& graph);
  void refuse(const std::vector<std::string>& problems);
  [[nodiscard]] std::string status() const;

  std::string file_;  // empty: defaults
  CommandLine command_line_;
  Config running_;                     // values that the stages have
  std::string hash_;                   // of the accepted configuration
  std::vector<std::string> at_start_;  // accepted keys that wait for the next start
  std::vector<std::string> notes_;     // already logged
  Clock::time_point accepted_{};
  std::uint64_t refused_ = 0;              // reloads
  std::vector<std::string> last_refusal_;  // empty: the last reload was accepted
  ConfigWatch watch_;
};

}  // namespace isobar
