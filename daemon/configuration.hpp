// SPDX-License-Identifier: BSD-3-Clause
// The configuration in force of a running isobard: reloads it, keeps the last good one, tells about it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/config_change.hpp"
#include "config/config_layer.hpp"
#include "config/kept_config.hpp"
#include "config/problems.hpp"
#include "daemon/config_watch.hpp"
#include "ipc/topics.hpp"

namespace isobar {

class Graph;
class Service;

/// What the command line sets over the files.
using CommandLine = std::function<void(Config&)>;

/// The configuration in force. A changed file is validated as a whole, with all other files; it then takes
/// effect key by key (Apply), or is refused and changes nothing. What was accepted is kept on the disk for a
/// start with bad files. Main thread.
class Configuration {
 public:
  using Clock = std::chrono::steady_clock;

  /// Loads the files, or takes the defaults where `file` is empty. While the files are bad, takes the kept
  /// configuration, and says so.
  /// @param state_folder of the service; empty: nothing is kept
  /// @throws ConfigErrors as load_layers() when nothing is kept that could be used
  Configuration(const std::string& file, CommandLine command_line,
                const std::filesystem::path& state_folder = {});

  [[nodiscard]] const Config& config() const { return running_; }
  /// config_identity() of the main file; empty: defaults.
  [[nodiscard]] std::string name() const;
  /// One line for `systemctl status`.
  [[nodiscard]] std::string status() const;

  /// Call every tick of the supervise loop: reloads after SIGHUP and after a change of the files; writes the
  /// accepted configuration to the state folder.
  void poll(Graph& graph, Service& service);

  /// Adds the entries "configuration", "configuration/refused" and "configuration/next_start".
  void fill(ipc::HealthReport& report) const;

 private:
  void start();
  [[nodiscard]] LoadedConfig load() const;
  void start_with_kept(const ConfigErrors& errors);
  void begin_at(std::int64_t since_s);
  [[nodiscard]] std::optional<KeptConfig> kept();
  void keep();
  void reload(Graph& graph);
  void take(LoadedConfig loaded, Graph& graph);
  void refuse(const std::vector<std::string>& problems);
  [[nodiscard]] double age_s() const;

  std::string file_;  // empty: defaults
  CommandLine command_line_;
  std::filesystem::path kept_file_;    // empty: nothing is kept
  Config accepted_config_;             // of the files, without the command line
  Config running_;                     // values that the stages have
  std::string hash_;                   // of the accepted configuration
  std::string kept_hash_;              // of what the file holds; empty: nothing, or not known
  std::vector<std::string> at_start_;  // accepted keys that wait for the next start
  std::vector<std::string> notes_;     // already logged
  Clock::time_point accepted_{};
  std::int64_t accepted_utc_s_ = 0;
  double age_before_s_ = 0.0;  // of an accepted configuration that earlier runs had
  bool runs_kept_ = false;     // since the start, as the files are bad
  Clock::time_point next_keep_{};
  std::string keep_failure_;               // logged
  std::uint64_t refused_ = 0;              // reloads
  std::vector<std::string> last_refusal_;  // empty: the last reload was accepted
  ConfigWatch watch_;
};

}  // namespace isobar
