// SPDX-License-Identifier: BSD-3-Clause
// Where the settings of the bridge come from: from isobard, once it runs, else from the files.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/bridge/settings.hpp"
#include "ipc/inputs.hpp"

namespace isobar::bridge {

/// One program decides, the other follows: isobard says which values of the configuration are in force, and the
/// bridge takes them, whatever the files hold by then. Only a bridge that was given another file than isobard
/// uses its own. Main thread.
class SettingsSource {
 public:
  /// Reads the files; while they are bad, what isobard has kept in the state folder of the service.
  /// @throws ConfigError when there is neither, or when an option or the environment breaks a rule
  explicit SettingsSource(const Options& options);
  /// From the description of the running isobard, for a start with bad files.
  /// @throws ConfigError when isobard runs with another configuration file, or an option breaks a rule
  SettingsSource(const Options& options, const ipc::RunDescription& isobard);

  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }

  /// Takes what isobard has in force. Logs where it cannot be taken.
  /// @return whether the settings are others now
  bool follow(const ipc::RunDescription& isobard);
  /// Reads the files again, after SIGHUP, unless isobard decides. Logs what is refused.
  /// @return whether the settings are others now
  bool reload();

 private:
  [[nodiscard]] bool is_ours(const ipc::RunDescription& isobard) const;
  bool take(Settings settings);
  void say_once(const std::string& line);

  const Options& options_;
  std::string name_;  // config_identity() of the main file; empty: none was given
  Settings settings_;
  bool follows_ = false;
  std::string said_;
};

}  // namespace isobar::bridge
