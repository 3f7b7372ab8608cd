// SPDX-License-Identifier: BSD-3-Clause
// Cost of the pose graph of a large building: optimised at once, with loops all right and with a fifth wrong, growing, and
// asked for covariances. CPU time of one thread, so that other load counts little.
// Usage: bench_graph [NODES] [LOOPS] [RUNS]; 10 000 nodes, 200 loops and 5 runs of other seeds by default. Fails where the
// median or the memory is beyond the figure: 2 s, 500 MB.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <vector>

#include "core/graph/pose_graph.hpp"
#include "tests/core/graph/simulated_building.hpp"

namespace {

using namespace isobar;        // NOLINT(google-build-using-namespace): a program
using namespace isobar::test;  // NOLINT(google-build-using-namespace)

constexpr double kLargestMs = 2000.0;
constexpr double kLargestMb = 500.0;
constexpr int kStep = 20;    // nodes between two calls of a growing graph
constexpr int kCalls = 20;   // of a growing graph
constexpr int kPairs = 500;  // covariances a run

double cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Durations of one kind of call.
class Times {
 public:
  void time(const std::function<void()>& call) {
    const double begin = cpu_ms();
    call();
    ms_.push_back(cpu_ms() - begin);
  }
  double print(const char* what) {
    std::sort(ms_.begin(), ms_.end());
    const auto at = [&](double share) {
      return ms_[static_cast<std::size_t>(share * static_cast<double>(ms_.size() - 1) + 0.5)];
    };
    std::printf("%-44s %6zu calls  p50 %9.3f ms  p99 %9.3f ms  max %9.3f ms\n", what, ms_.size(), at(0.5),
                at(0.99), ms_.back());
    return at(0.5);
  }

 private:
  std::vector<double> ms_;
};

/// Loops of all runs by truth and verdict.
struct Verdicts {
  int right_taken = 0;
  int right_rejected = 0;
  int wrong_taken = 0;
  int wrong_rejected = 0;

  void count(const PoseGraph& graph, const Building& building, const std::vector<int>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const bool taken = graph.loops()[i].weight > 0.0;
      const bool right = building.loop_right[static_cast<std::size_t>(numbers[i])];
      ++(right ? (taken ? right_taken : right_rejected) : (taken ? wrong_taken : wrong_rejected));
    }
  }
  void print() const {
    std::printf("%-44s %6d right ones taken, %d rejected; %d wrong ones taken, %d rejected\n", "  loops",
                right_taken, right_rejected, wrong_taken, wrong_rejected);
  }
};

/// The last nodes of a drive come one submap after the other, with their loops.
void time_growing(const Building& building, int nodes, Times& times) {
  PoseGraph graph;
  const int begin = nodes - kStep * kCalls;
  add_drive(building, 0, begin, graph);
  add_loops(building, 0, begin, true, true, graph);
  graph.optimise();
  for (int at = begin; at < nodes; at += kStep) {
    add_drive(building, at, at + kStep, graph);
    add_loops(building, at, at + kStep, true, true, graph);
    times.time([&] { graph.optimise(); });
  }
}

void time_covariances(PoseGraph& graph, Times& times) {
  const int nodes = static_cast<int>(graph.nodes().size());
  for (int i = 0; i < kPairs; ++i) {
    const int a = i * 7919 % nodes;
    const int b = (a + 1 + i * 104729 % (nodes - 1)) % nodes;
    times.time([&] { static_cast<void>(graph.relative_covariance(a, b)); });
  }
}

/// @return median of optimise() [ms]
double run(const char* what, BuildingOptions options, int runs) {
  Times at_once;
  Times growing;
  Times covariances;
  Verdicts verdicts;
  for (int n = 0; n < runs; ++n) {
    options.seed = static_cast<unsigned>(n + 1);
    const Building building = make_building(options);
    PoseGraph graph;
    add_drive(building, 0, options.nodes, graph);
    const std::vector<int> numbers = add_loops(building, 0, options.nodes, true, true, graph);
    at_once.time([&] { graph.optimise(); });
    verdicts.count(graph, building, numbers);
    time_covariances(graph, covariances);
    if (n % 5 == 0) time_growing(building, options.nodes, growing);
  }
  std::printf("%s\n", what);
  const double median_ms = at_once.print("  optimised at once");
  growing.print("  optimised again after 20 nodes");
  covariances.print("  relative covariance");
  verdicts.print();
  return median_ms;
}

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  BuildingOptions options;
  options.nodes = number(1, 10'000);
  const int loops = number(2, 200);
  const int runs = number(3, 5);
  if (options.nodes < 1'000 || loops < 0 || runs < 1) {
    std::fprintf(stderr, "usage: bench_graph [NODES >= 1000] [LOOPS] [RUNS]\n");
    return 64;
  }
  std::printf("%d nodes, %d loops\n", options.nodes, loops);
  double slowest_ms = 0.0;
  for (const bool held : {true, false}) {
    for (const int wrong : {0, loops / 5}) {
      options.held_by_gravity = held;
      options.wrong_loops = wrong;
      options.right_loops = loops - wrong;
      const char* kind = held ? "4-DOF" : "6-DOF";
      std::printf("%s, %d wrong:", kind, wrong);
      slowest_ms = std::max(slowest_ms, run("", options, runs));
    }
  }
  std::printf("peak memory %.0f MB\n", peak_mb());
  const bool good = slowest_ms <= kLargestMs && peak_mb() <= kLargestMb;
  std::printf("%s\n", good ? "within 2 s and 500 MB" : "BEYOND 2 s or 500 MB");
  return good ? 0 : 1;
}
