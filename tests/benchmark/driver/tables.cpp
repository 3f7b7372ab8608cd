// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/benchmark/driver/result.hpp"

namespace isobar::bench {

namespace {

double number(const Json& value) { return value.is_number() ? value.get<double>() : 0.0; }

void print_quantiles(const std::string& label, const Json& row, int decimals) {
  std::printf("  %-34s", label.c_str());
  if (!row.is_object()) {
    std::printf("    %s\n", row.is_string() ? row.get<std::string>().c_str() : "-");
    return;
  }
  for (const char* key : {"median", "p90", "p99", "max", "mean"}) {
    std::printf("%10.*f", decimals, number(row[key]));
  }
  std::printf("\n");
}

void print_header(const char* title) {
  std::printf("  %-34s%10s%10s%10s%10s%10s\n", title, "median", "p90", "p99", "max", "mean");
}

void print_error(const Json& error) {
  if (error.is_null()) {
    std::printf("no reference\n");
    return;
  }
  std::printf("%.3f m at the end (%+.3f m of height), ATE rms %.3f m, after %.1f m\n",
              number(error["final_m"]), number(error["final_height_m"]), number(error["ate_rms_m"]),
              number(error["travelled_m"]));
}

void print_memory(const Json& memory) {
  std::printf("  memory: %.1f MB at the start, %.1f MB at the end; %.0f cells, %.0f planes, %.0f tiles",
              number(memory["start_bytes"]) * 1e-6, number(memory["end_bytes"]) * 1e-6,
              number(memory["cells"]), number(memory["planes"]), number(memory["tiles"]));
  std::printf("; grown by %.0f bytes a cell\n", number(memory["grown_bytes_per_cell"]));
}

void print_own(const Json& data) {
  std::printf("\n%s: %.0f scans, %.0f registered, median of %.0f passes\n",
              data["name"].get<std::string>().c_str(), number(data["scans"]), number(data["registered"]),
              number(data["passes"]));
  print_header("CPU ms a scan");
  for (const auto& [key, row] : data["ms"].items()) print_quantiles(key, row, 4);
  const Json& growth = data["growth"];
  if (growth.is_object())
    std::printf("  growth: %.3f ms a scan in the first tenth, %.3f in the last: %.2f times (median %.2f)\n",
                number(growth["first_mean_ms"]), number(growth["last_mean_ms"]), number(growth["mean_ratio"]),
                number(growth["median_ratio"]));
  print_memory(data["memory"]);
  print_header("allocations a scan");
  for (const auto& [key, row] : data["allocations"].items()) print_quantiles(key, row, 0);
  print_header("counts a scan");
  for (const auto& [key, row] : data["counters"].items()) print_quantiles(key, row, 0);
  std::printf("  error: ");
  print_error(data["error"]);
}

void print_peers(const Json& peers) {
  if (peers.is_string()) {
    std::printf("\n  peers: %s\n", peers.get<std::string>().c_str());
    return;
  }
  for (const Json& system : peers) {
    std::printf("\n  side by side: %s (%.0f scans not converged)\n",
                system["name"].get<std::string>().c_str(), number(system["not_converged"]));
    print_header("CPU ms a scan");
    for (const auto& [key, row] : system["ms"].items()) print_quantiles(key, row, 3);
    if (system.contains("ratio")) {
      const Json& ratio = system["ratio"];
      std::printf("  ours is faster by a factor of %.1f (registration), %.1f (with map; %.1f by the means)\n",
                  number(ratio["registration"]["median"]), number(ratio["registration + map"]["median"]),
                  number(ratio["registration + map, of the means"]));
    }
    std::printf("  error: ");
    print_error(system["error"]);
  }
}

}  // namespace

void print_tables(const Json& result) {
  const Json& machine = result["machine"];
  std::printf("%s, %.0f processors, %s\n", machine["processor"].get<std::string>().c_str(),
              number(machine["processors"]), machine["kernel"].get<std::string>().c_str());
  for (const Json& data : result["data"]) {
    print_own(data);
    if (data.contains("peers")) print_peers(data["peers"]);
  }
}

}  // namespace isobar::bench
