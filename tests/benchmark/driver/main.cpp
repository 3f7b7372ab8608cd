// SPDX-License-Identifier: BSD-3-Clause
// isobar_benchmark: cost per scan of registration and map, compared with peers.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "tests/benchmark/driver/compare.hpp"
#include "tests/benchmark/driver/driver.hpp"
#include "tests/benchmark/driver/result.hpp"

namespace isobar::bench {

namespace {

void write_json(const std::string& file, const Json& value) {
  std::ofstream stream(file);
  stream << value.dump(1) << '\n';
  if (!stream.flush()) throw DataError(file + ": cannot be written");
}

void add_run(CLI::App& app, DriverOptions& options, std::string& config, std::string& out,
             std::string& micro) {
  CLI::App* run = app.add_subcommand("run", "Measure on recordings, scenarios and clouds");
  run->add_option("DATA", options.data, "recording folder, folder of *.pcd or *.bin, or scenario")
      ->required();
  run->add_option("--seed", options.data_options.seed, "random seed of scenarios")->capture_default_str();
  run->add_option("--stop-after", options.data_options.stop_after_s,
                  "use only the first part of a recording [s]")
      ->check(CLI::PositiveNumber);
  run->add_option("--cache", options.data_options.cache, "folder for recordings of scenarios")
      ->capture_default_str();
  run->add_option("--config", config, "TOML file; sensors and mounts come from the recording")
      ->check(CLI::ExistingFile);
  run->add_option("--repeat", options.repeat, "passes; each figure of a scan is the median over them")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  run->add_flag("!--no-stages", options.with_stages, "do not measure the stages of a registration");
  run->add_flag("!--no-peers", options.with_peers, "do not run the peers");
  run->add_option("--peer-scans", options.peer_scans, "largest number of scans with the peers")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  run->add_option("--micro", micro, "JSON of Google Benchmark to include in the result")
      ->check(CLI::ExistingFile);
  run->add_option("--out", out, "file for the result as JSON");
  run->callback([&] {
    if (!config.empty()) options.data_options.config = load_config(config);
    Json result = run_benchmark(options);
    if (!micro.empty()) result["micro"] = read_json(micro)["benchmarks"];
    print_tables(result);
    if (!out.empty()) write_json(out, result);
  });
}

void add_compare(CLI::App& app, std::vector<std::string>& a, std::vector<std::string>& b, std::string& out) {
  CLI::App* compare = app.add_subcommand("compare", "Compare two builds by results of alternating runs");
  compare->add_option("--a", a, "results of the first build, in order")->required()->check(CLI::ExistingFile);
  compare->add_option("--b", b, "results of the second build, in order")
      ->required()
      ->check(CLI::ExistingFile);
  compare->add_option("--out", out, "file for the ratios as JSON");
  compare->callback([&] {
    const Json ratios = compare_results(a, b);
    print_comparison(ratios);
    if (!out.empty()) write_json(out, ratios);
  });
}

int main_with_errors(int argc, char** argv) {
  CLI::App app{"isobar_benchmark: cost per scan of registration and map. Times are CPU times of the thread."};
  app.require_subcommand(1);
  DriverOptions options;
  std::string config;
  std::string out;
  std::string micro;
  std::vector<std::string> a;
  std::vector<std::string> b;
  add_run(app, options, config, out, micro);
  add_compare(app, a, b, out);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 64;
  }
  return 0;
}

}  // namespace

}  // namespace isobar::bench

int main(int argc, char** argv) {
  try {
    return isobar::bench::main_with_errors(argc, argv);
  } catch (const isobar::Error& error) {
    std::fprintf(stderr, "isobar_benchmark: %s\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "isobar_benchmark: unexpected: %s\n", error.what());
    return 70;
  }
}
