// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"

namespace isobar {

/// All errors of a configuration. what(): the first one, and how many follow.
class ConfigErrors : public ConfigError {
 public:
  /// @param all "place: key: rule", at least one
  explicit ConfigErrors(std::vector<std::string> all) : ConfigError(summary(all)), all_(std::move(all)) {}
  [[nodiscard]] const std::vector<std::string>& all() const noexcept { return all_; }

 private:
  static std::string summary(const std::vector<std::string>& all) {
    const std::size_t more = all.size() - 1;
    return more == 0
               ? all.front()
               : all.front() + " (and " + std::to_string(more) + " more; `isobar config check` lists them)";
  }
  std::vector<std::string> all_;
};

/// Collects the errors of a configuration, so that all are told at once.
class Problems {
 public:
  /// Errors kept: a foreign file may hold thousands of unknown keys.
  static constexpr std::size_t kMost = 100;

  void add(std::string problem) {
    if (problems_.size() < kMost) problems_.push_back(std::move(problem));
  }
  /// Calls `check` and collects the ConfigError that it throws.
  template <class Check>
  void attempt(const Check& check) {
    try {
      check();
    } catch (const ConfigErrors& errors) {
      for (const std::string& problem : errors.all()) add(problem);
    } catch (const ConfigError& error) {
      add(error.what());
    }
  }
  [[nodiscard]] bool empty() const noexcept { return problems_.empty(); }
  /// @throws ConfigErrors when there are any
  void throw_if_any() const {
    if (!problems_.empty()) throw ConfigErrors(problems_);
  }

 private:
  std::vector<std::string> problems_;
};

}  // namespace isobar
