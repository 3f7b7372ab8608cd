// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a logger's CSV. Accepted samples are in order of time, plausible and finite.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/recording/pressure_log.hpp"

namespace {

const std::filesystem::path& file() {
  static const std::filesystem::path path = [] {
    const char* base = std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp";
    std::atexit([] { std::filesystem::remove(file()); });
    return std::filesystem::path(base) / ("isobar-fuzz-" + std::to_string(getpid()) + ".csv");
  }();
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ofstream(file(), std::ios::binary | std::ios::trunc)
      << std::string_view(reinterpret_cast<const char*>(data), size);
  try {
    const auto log = isobar::recording::read_pressure_log(file(), {});
    std::int64_t newest_ns = -1;
    for (const isobar::PressureSample& sample : log.samples) {
      if (sample.stamp_ns <= newest_ns || isobar::implausible_stamp(sample.stamp_ns) != nullptr ||
          isobar::implausibility(sample) != nullptr) {
        std::abort();
      }
      newest_ns = sample.stamp_ns;
    }
    if (log.samples.empty() || log.notes.empty()) {
      std::abort();
    }
  } catch (const isobar::DataError&) {
    return 0;  // the specified refusal
  }
  return 0;
}
