// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/result.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <thread>

#include "core/statistics/distribution.hpp"
#include "run/evaluation/figures.hpp"

namespace isobar::bench {

namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Median over the passes of `figure`, for each scan.
template <class Figure>
std::vector<double> over_passes(const std::vector<Pass>& passes, Figure figure) {
  std::vector<double> values(passes.front().scans.size());
  std::vector<double> of_scan(passes.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < passes.size(); ++k) of_scan[k] = figure(passes[k].scans[i]);
    values[i] = median(of_scan);
  }
  return values;
}

/// Growth: last tenth of the registered scans against the first.
Json growth_json(const std::vector<double>& total_ms) {
  if (total_ms.empty()) return nullptr;
  const std::size_t tenth = std::max<std::size_t>(1, total_ms.size() / 10);
  const auto count = static_cast<std::ptrdiff_t>(tenth);
  const std::vector<double> first(total_ms.begin(), total_ms.begin() + count);
  const std::vector<double> last(total_ms.end() - count, total_ms.end());
  return {{"scans", tenth},
          {"first_mean_ms", mean(first)},
          {"last_mean_ms", mean(last)},
          {"mean_ratio", mean(last) / mean(first)},
          {"median_ratio", median(last) / median(first)}};
}

/// Total times of registered scans: before the first one there is no map that could grow.
std::vector<double> registered_totals(const std::vector<Pass>& passes) {
  const std::vector<double> all = over_passes(passes, [](const ScanCosts& scan) { return scan.total_ms(); });
  std::vector<double> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (passes.front().scans[i].registered) kept.push_back(all[i]);
  }
  return kept;
}

Json memory_json(const std::vector<MemorySample>& samples) {
  Json rows = Json::array();
  for (const MemorySample& sample : samples) {
    rows.push_back({{"scan", sample.scan},
                    {"cells", sample.cells},
                    {"planes", sample.planes},
                    {"tiles", sample.tiles},
                    {"resident_bytes", sample.resident_bytes}});
  }
  const auto& first = samples.front();
  const auto& last = samples.back();
  const double grown = static_cast<double>(last.resident_bytes) - static_cast<double>(first.resident_bytes);
  return {{"start_bytes", first.resident_bytes},
          {"end_bytes", last.resident_bytes},
          {"cells", last.cells},
          {"planes", last.planes},
          {"tiles", last.tiles},
          {"grown_bytes_per_cell", last.cells > 0 ? Json(grown / static_cast<double>(last.cells)) : Json()},
          {"samples", rows}};
}

Json allocations_json(const Pass& pass) {
  std::vector<double> registration;
  std::vector<double> map;
  for (const ScanCosts& scan : pass.scans) {
    registration.push_back(static_cast<double>(scan.registration_allocations));
    map.push_back(static_cast<double>(scan.map_allocations));
  }
  return {{"registration", quantiles_json(registration)}, {"map", quantiles_json(map)}};
}

/// Hardware counts per scan; for a counter that is not available, the reason.
Json counters_json(const std::vector<Pass>& passes) {
  const CounterRefusals& refusals = passes.front().refusals;
  const auto of = [&](const std::string& refusal, HardwareCounts ScanCosts::*part,
                      std::uint64_t HardwareCounts::*count) -> Json {
    if (!refusal.empty()) return refusal;
    return quantiles_json(
        over_passes(passes, [&](const ScanCosts& scan) { return static_cast<double>((scan.*part).*count); }));
  };
  using Scan = ScanCosts;
  using Counts = HardwareCounts;
  return {{"instructions, registration",
           of(refusals.instructions, &Scan::registration_counts, &Counts::instructions)},
          {"instructions, map", of(refusals.instructions, &Scan::map_counts, &Counts::instructions)},
          {"cache misses, registration",
           of(refusals.cache_misses, &Scan::registration_counts, &Counts::cache_misses)},
          {"cache misses, map", of(refusals.cache_misses, &Scan::map_counts, &Counts::cache_misses)}};
}

/// Error of the path against the reference, aligned at the start; null without a reference.
Json error_json(const DataSet& data, const std::vector<evaluation::StampedPose>& poses) {
  if (data.reference().empty()) return nullptr;
  const auto result = evaluation::evaluate(data.reference(), {}, evaluation::make_trajectory(poses), {});
  const evaluation::PosePair& last = result.pairs.back();
  return {{"final_m", (last.estimate.position_m - last.reference.position_m).norm()},
          {"final_height_m", last.estimate.position_m.z() - last.reference.position_m.z()},
          {"ate_rms_m", result.figures.ate_rms_m},
          {"travelled_m", last.distance_m}};
}

Json stages_json(const std::vector<Pass>& passes, const std::vector<StageCosts>& stages) {
  const auto of = [&](auto figure) { return quantiles_json(over_passes(passes, figure)); };
  const auto stage = [&](double StageCosts::*member) {
    std::vector<double> values;
    values.reserve(stages.size());
    for (const StageCosts& costs : stages) values.push_back(costs.*member);
    return quantiles_json(values);
  };
  std::vector<double> updates;
  std::vector<double> hand_overs;
  const auto map_ms = over_passes(passes, [](const ScanCosts& scan) { return scan.map_ms; });
  const auto hand_over_ms = over_passes(passes, [](const ScanCosts& scan) { return scan.hand_over_ms; });
  for (std::size_t i = 0; i < map_ms.size(); ++i) {
    if (!passes.front().scans[i].map_changed) continue;
    updates.push_back(map_ms[i]);
    hand_overs.push_back(hand_over_ms[i]);
  }
  const bool decodes = passes.front().scans.front().decode_ms > 0.0;
  return {{"decode", decodes ? of([](const ScanCosts& scan) { return scan.decode_ms; }) : Json()},
          {"deskew", stage(&StageCosts::deskew_ms)},
          {"sample", stage(&StageCosts::sample_ms)},
          {"match", stage(&StageCosts::match_ms)},
          {"solve", stage(&StageCosts::solve_ms)},
          {"registration", of([](const ScanCosts& scan) { return scan.registration_ms; })},
          {"map update, where taken", quantiles_json(updates)},
          {"map update, every scan", quantiles_json(map_ms)},
          {"snapshot hand-over", quantiles_json(hand_overs)},
          {"registration + map", of([](const ScanCosts& scan) { return scan.total_ms(); })}};
}

std::vector<double> totals(const SystemRun& run) {
  std::vector<double> sums;
  for (std::size_t i = 0; i < run.map_ms.size(); ++i) sums.push_back(run.registration_ms[i] + run.map_ms[i]);
  return sums;
}

Json run_json(const DataSet& data, const SystemRun& run) {
  return {{"name", run.name},
          {"ms",
           {{"registration", quantiles_json(run.registration_ms)},
            {"map update, every scan", quantiles_json(run.map_ms)},
            {"registration + map", quantiles_json(totals(run))}}},
          {"not_converged", run.failures},
          {"error", error_json(data, run.poses)}};
}

std::vector<double> ratios(const std::vector<double>& theirs, const std::vector<double>& ours) {
  std::vector<double> values;
  for (std::size_t i = 0; i < ours.size(); ++i) values.push_back(theirs[i] / ours[i]);
  return values;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

Json quantiles_json(std::vector<double> values) {
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  return {{"count", values.size()},       {"mean", mean(values)},          {"median", quantile(values, 0.5)},
          {"p90", quantile(values, 0.9)}, {"p99", quantile(values, 0.99)}, {"max", values.back()}};
}

Json own_figures(const DataSet& data, const std::vector<Pass>& passes,
                 const std::vector<StageCosts>& stages) {
  const Pass& first = passes.front();
  const auto registered = std::count_if(first.scans.begin(), first.scans.end(),
                                        [](const ScanCosts& scan) { return scan.registered; });
  return {{"name", data.name()},
          {"scans", first.scans.size()},
          {"registered", registered},
          {"passes", passes.size()},
          {"ms", stages_json(passes, stages)},
          {"growth", growth_json(registered_totals(passes))},
          {"memory", memory_json(first.memory)},
          {"allocations", allocations_json(first)},
          {"counters", counters_json(passes)},
          {"error", error_json(data, first.poses)}};
}

Json peer_figures(const DataSet& data, const PeerPass& pass) {
  Json systems = Json::array({run_json(data, pass.ours)});
  for (const SystemRun& peer : pass.peers) {
    Json row = run_json(data, peer);
    row["ratio"] = {{"registration", quantiles_json(ratios(peer.registration_ms, pass.ours.registration_ms))},
                    {"registration + map", quantiles_json(ratios(totals(peer), totals(pass.ours)))},
                    {"registration + map, of the means", mean(totals(peer)) / mean(totals(pass.ours))}};
    systems.push_back(std::move(row));
  }
  return systems;
}

Json machine_json() {
  utsname names{};
  uname(&names);
  return {{"processor", processor()},
          {"processors", std::thread::hardware_concurrency()},
          {"kernel", std::string(names.sysname) + " " + names.release},
          {"compiler", __VERSION__}};
}

}  // namespace isobar::bench
