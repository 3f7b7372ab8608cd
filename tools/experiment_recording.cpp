// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment_recording.hpp"

#include "core/errors.hpp"
#include "core/names.hpp"
#include "core/nearest_word.hpp"
#include "run/recording/manifest.hpp"
#include "tools/method_option.hpp"

namespace isobar::tools {

bool simulate_if_missing(const simulation::ScenarioRequest& request, const std::filesystem::path& recording,
                         const std::function<void(double)>& progress) {
  if (std::filesystem::exists(recording / recording::kManifestFile)) return false;
  const std::filesystem::path unfinished = recording.string() + ".unfinished";
  std::filesystem::remove_all(unfinished);
  simulation::simulate(request, unfinished, progress);
  std::filesystem::rename(unfinished, recording);
  return true;
}

std::vector<Method> chosen_methods(const std::vector<std::string>& names) {
  if (names.empty()) return {kAllMethods.begin(), kAllMethods.end()};
  std::vector<Method> methods;
  for (const std::string& name : names) {
    const auto method = kMethodNames.value(name);
    if (!method)
      throw UsageError("--methods: \"" + name + "\" is none of " + method_names() +
                       did_you_mean(name, kMethodNames.names()));
    methods.push_back(*method);
  }
  return methods;
}

}  // namespace isobar::tools
