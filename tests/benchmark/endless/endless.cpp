// SPDX-License-Identifier: BSD-3-Clause
// Growth of the cost per scan over 10 km: replays a long recording and prints, for each tenth of it, the cost
// per scan of registration and of all stages, and the memory and disk used.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "daemon/cpu_time.hpp"
#include "daemon/replay.hpp"
#include "run/evaluation/run_folder.hpp"
#include "tools/method_option.hpp"

namespace {

namespace fs = std::filesystem;
using isobar::Config;

constexpr std::size_t kParts = 10;

struct Options {
  fs::path recording;
  fs::path out = "out/endless";
  fs::path config;
  std::string method;
};

/// State of the process at a time of the recording.
struct Sample {
  double fraction = 0.0;
  double cpu_ms = 0.0;
  double resident_mb = 0.0;
  double disk_mb = 0.0;
};

double resident_mb() {
  std::ifstream file("/proc/self/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  if (!(file >> total_pages >> resident_pages))
    throw isobar::ServiceError("/proc/self/statm: cannot be read");
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

double disk_mb(const fs::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  }
  return bytes * 1e-6;
}

std::size_t part_of(double fraction) {
  return static_cast<std::size_t>(std::clamp(fraction * kParts, 0.0, kParts - 1.0));
}

struct Spread {
  double median = NAN;
  double p99 = NAN;
  double max = NAN;
};

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.99), values.back()};
}

/// One tenth of the recording.
struct Part {
  double driven_m = 0.0;
  std::vector<double> registration_ms;  ///< per scan
  std::vector<double> all_ms;           ///< per scan, mean over a window of about half a second
  double resident_mb = 0.0;             ///< largest value in the part
  double disk_mb = 0.0;                 ///< at the end of the part
};

std::vector<Sample> replay(const Options& options, const Config& config) {
  std::vector<Sample> samples;
  const isobar::CpuTimer timer;
  isobar::replay(options.recording, config, options.out, [&](double fraction) {
    Sample sample{fraction, timer.elapsed_ms(), resident_mb(), 0.0};
    // Disk usage once per part, because walking the folder is slow.
    const bool begins = samples.empty() || part_of(fraction) != part_of(samples.back().fraction);
    sample.disk_mb = begins ? disk_mb(options.out) : samples.back().disk_mb;
    if (begins) std::fprintf(stderr, "\r%3.0f %%", 100.0 * fraction);
    samples.push_back(sample);
  });
  std::fprintf(stderr, "\r     \r");
  samples.push_back({1.0, timer.elapsed_ms(), resident_mb(), disk_mb(options.out)});
  return samples;
}

std::vector<Part> collect(const Options& options, const std::vector<Sample>& samples) {
  const auto run = isobar::evaluation::read_run_folder(options.out, 1);
  std::vector<Part> parts(kParts);
  if (run.status.size() < kParts) throw isobar::DataError(options.out.string() + ": too few poses");
  const auto start_ns = static_cast<double>(run.status.front().stamp_ns);
  const double span_ns = static_cast<double>(run.status.back().stamp_ns) - start_ns;
  const auto part_at = [&](std::int64_t stamp_ns) -> Part& {
    return parts[part_of((static_cast<double>(stamp_ns) - start_ns) / span_ns)];
  };
  std::size_t scans = 0;
  for (const auto& row : run.status) {
    if (row.mode != "registered" || !std::isfinite(row.scan_ms)) continue;
    part_at(row.stamp_ns).registration_ms.push_back(row.scan_ms);
    ++scans;
  }
  const auto& poses = run.trajectory.poses;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    part_at(poses[i].stamp_ns).driven_m += (poses[i].position_m - poses[i - 1].position_m).norm();
  }
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double window_scans = (samples[i].fraction - samples[i - 1].fraction) * static_cast<double>(scans);
    Part& part = parts[part_of(samples[i].fraction)];
    if (window_scans > 1.0) part.all_ms.push_back((samples[i].cpu_ms - samples[i - 1].cpu_ms) / window_scans);
    part.resident_mb = std::max(part.resident_mb, samples[i].resident_mb);
    // The disk is measured when a part begins, which is the end of the previous one.
    const std::size_t index = part_of(samples[i].fraction);
    if (index > 0 && part_of(samples[i - 1].fraction) != index) parts[index - 1].disk_mb = samples[i].disk_mb;
  }
  parts.back().disk_mb = samples.back().disk_mb;
  return parts;
}

void print(const std::vector<Part>& parts) {
  std::printf("                       registration [ms]        all stages [ms a scan]*\n");
  std::printf(
      "tenth    m   scans   median    p99    max     median    p99    max   memory [MB]  disk [MB]\n");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const Spread registration = spread_of(part.registration_ms);
    const Spread all = spread_of(part.all_ms);
    std::printf("%5zu %5.0f  %5zu   %6.2f %6.2f %6.2f     %6.2f %6.2f %6.2f   %11.0f %10.0f\n", i + 1,
                part.driven_m, part.registration_ms.size(), registration.median, registration.p99,
                registration.max, all.median, all.p99, all.max, part.resident_mb, part.disk_mb);
  }
  const Part& first = parts.front();
  const Part& last = parts.back();
  std::printf("last tenth / first, medians: registration %.2f, all stages %.2f; memory %+.0f MB\n",
              spread_of(last.registration_ms).median / spread_of(first.registration_ms).median,
              spread_of(last.all_ms).median / spread_of(first.all_ms).median,
              last.resident_mb - first.resident_mb);
  std::printf(
      "* CPU time of decoding, prior, registration, map update and output, mean of windows of 0.5 s\n");
}

int run(const Options& options) {
  Config config = options.config.empty() ? Config{} : isobar::load_config(options.config);
  if (!options.method.empty()) {
    const std::optional<isobar::Method> method = isobar::kMethodNames.value(options.method);
    if (!method)
      throw isobar::UsageError("--method: \"" + options.method + "\" is none of " +
                               isobar::tools::method_names());
    config.method = *method;
  }
  print(collect(options, replay(options, config)));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Cost per scan, memory and disk along a long recording, one line for each tenth"};
  Options options;
  app.add_option("RECORDING", options.recording, "recording folder, of `isobar simulate city-10km`")
      ->required();
  app.add_option("--out", options.out, "folder of the run")->capture_default_str();
  app.add_option("--config", options.config, "TOML file");
  app.add_option("--method", options.method, isobar::tools::method_names());
  CLI11_PARSE(app, argc, argv);
  try {
    return run(options);
  } catch (const isobar::Error& error) {
    std::fprintf(stderr, "endless: %s\n", error.what());
    return error.exit_code();
  }
}
