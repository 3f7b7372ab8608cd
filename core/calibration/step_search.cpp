// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/calibration/staircase.hpp"
#include "core/calibration/still_period.hpp"

namespace isobar {

namespace {

// Averaging time of a block, and the largest number of blocks: bounds the time of the search.
constexpr double kBlockS = 0.25;
constexpr double kMaxBlocks = 4000.0;
// Time constant of the drift estimate: drift is slower than steps.
constexpr double kDriftMemoryS = 60.0;
// Deviation at which the cost saturates: a door must not look like a staircase.
constexpr double kLargestDeviationSteps = 2.0;
// Levels above and below the first: bounds the memory.
constexpr int kMaxLevels = 60;
constexpr double kUnreachable = std::numeric_limits<double>::infinity();

/// Track averaged over blocks, heights in steps.
struct Blocks {
  std::vector<double> begins_s;
  std::vector<double> levels;
  double length_s = kBlockS;
};

Blocks blocks_of(const HeightTrack& track, double step_m) {
  Blocks blocks;
  const double span_s = track.times_s.back() - track.times_s.front();
  const double interval_s = span_s / static_cast<double>(track.times_s.size() - 1);
  blocks.length_s = std::max({kBlockS, interval_s, span_s / kMaxBlocks});
  for (std::size_t begin = 0; begin < track.times_s.size();) {
    double sum_m = 0.0;
    std::size_t end = begin;
    while (end < track.times_s.size() && track.times_s[end] < track.times_s[begin] + blocks.length_s) {
      sum_m += track.heights_m[end++] - track.heights_m.front();
    }
    blocks.begins_s.push_back(track.times_s[begin]);
    blocks.levels.push_back(sum_m / static_cast<double>(end - begin) / step_m);
    begin = end;
  }
  return blocks;
}

/// Density of the white noise [steps^2 s].
double noise_density(const HeightTrack& track, double step_m) {
  const double sigma = robust_sigma(track.heights_m) / step_m;
  const double span_s = track.times_s.back() - track.times_s.front();
  return sigma * sigma * span_s / static_cast<double>(track.times_s.size() - 1);
}

/// A sequence of levels.
struct Sequence {
  std::vector<std::size_t> changes;  // blocks at which a new level begins
  double misfit = 0.0;               // cost without the penalties
};

enum class Direction : std::uint8_t { kUp, kDown, kEither };

/// The most likely sequence of levels for one penalty.
class Viterbi {
 public:
  Viterbi(const Blocks& blocks, double min_dwell_s, Direction direction)
      : blocks_(blocks),
        direction_(direction),
        ages_(std::max(1, static_cast<int>(std::lround(min_dwell_s / blocks.length_s)))) {
    const auto [low, high] = std::minmax_element(blocks.levels.begin(), blocks.levels.end());
    below_ = std::min(kMaxLevels, 1 + static_cast<int>(std::ceil(blocks.levels.front() - *low)));
    levels_ =
        below_ + 1 + std::min(kMaxLevels, 1 + static_cast<int>(std::ceil(*high - blocks.levels.front())));
    came_from_.resize(blocks.levels.size() * states());
  }

  Sequence sequence(double penalty) {
    std::vector<State> now(states());
    now[index(below_, ages_ - 1)] = {0.0, blocks_.levels.front()};
    std::vector<State> next(states());
    for (std::size_t k = 0; k < blocks_.levels.size(); ++k) {
      std::fill(next.begin(), next.end(), State{});
      for (int level = 0; level < levels_; ++level) {
        for (int age = 0; age < ages_; ++age) {
          const State& state = now[index(level, age)];
          if (state.cost == kUnreachable) continue;
          offer(next, k, index(level, std::min(age + 1, ages_ - 1)), state, index(level, age), 0.0);
          if (age < ages_ - 1) continue;
          if (level > 0 && direction_ != Direction::kUp)
            offer(next, k, index(level - 1, 0), state, index(level, age), penalty);
          if (level + 1 < levels_ && direction_ != Direction::kDown)
            offer(next, k, index(level + 1, 0), state, index(level, age), penalty);
        }
      }
      measure(next, k);
      now.swap(next);
    }
    return trace_back(now, penalty);
  }

 private:
  struct State {
    double cost = kUnreachable;
    double drift = 0.0;  // drift estimate: present height of the first level [steps]
  };

  [[nodiscard]] std::size_t states() const {
    return static_cast<std::size_t>(levels_) * static_cast<std::size_t>(ages_);
  }
  [[nodiscard]] std::size_t index(int level, int age) const {
    return static_cast<std::size_t>(level) * static_cast<std::size_t>(ages_) + static_cast<std::size_t>(age);
  }

  void offer(std::vector<State>& next, std::size_t k, std::size_t to, const State& state, std::size_t from,
             double penalty) {
    if (state.cost + penalty >= next[to].cost) return;
    next[to] = {state.cost + penalty, state.drift};
    came_from_[k * states() + to] = static_cast<std::int32_t>(from);
  }

  /// Adds the deviation of block k to the cost of every state and updates its drift.
  void measure(std::vector<State>& next, std::size_t k) const {
    const double follow = std::max(1.0 / (static_cast<double>(k) + 1.0), blocks_.length_s / kDriftMemoryS);
    for (int level = 0; level < levels_; ++level) {
      for (int age = 0; age < ages_; ++age) {
        State& state = next[index(level, age)];
        if (state.cost == kUnreachable) continue;
        const double off = blocks_.levels[k] - (level - below_) - state.drift;
        state.cost += blocks_.length_s * std::min(off * off, kLargestDeviationSteps * kLargestDeviationSteps);
        state.drift += follow * std::clamp(off, -kLargestDeviationSteps, kLargestDeviationSteps);
      }
    }
  }

  [[nodiscard]] Sequence trace_back(const std::vector<State>& last, double penalty) const {
    const auto best = std::min_element(last.begin(), last.end(),
                                       [](const State& a, const State& b) { return a.cost < b.cost; });
    auto state = static_cast<std::size_t>(best - last.begin());
    std::vector<std::size_t> changes;
    const double cost = best->cost;
    for (std::size_t k = blocks_.levels.size(); k-- > 0;) {
      const auto before = static_cast<std::size_t>(came_from_[k * states() + state]);
      if (before / static_cast<std::size_t>(ages_) != state / static_cast<std::size_t>(ages_)) {
        changes.push_back(k);
      }
      state = before;
    }
    std::reverse(changes.begin(), changes.end());
    const double misfit = cost - penalty * static_cast<double>(changes.size());
    return {std::move(changes), misfit};
  }

  const Blocks& blocks_;
  Direction direction_;
  int ages_;
  int below_ = 0;
  int levels_ = 1;
  std::vector<std::int32_t> came_from_;  // predecessor of each block and state
};

/// Bisection of the penalty (geometric) for a sequence with the wanted number of steps, or the nearest to it.
Sequence sequence_of_number(Viterbi& viterbi, std::size_t number, double penalty) {
  Sequence best = viterbi.sequence(penalty);
  double low = penalty;
  double high = penalty;
  for (int i = 0; i < 12 && viterbi.sequence(low).changes.size() < number; ++i) low *= 0.5;
  for (int i = 0; i < 24 && viterbi.sequence(high).changes.size() > number; ++i) high *= 2.0;
  const auto miss = [number](const Sequence& sequence) {
    const std::size_t size = sequence.changes.size();
    return std::max(size, number) - std::min(size, number);
  };
  for (int i = 0; i < 20 && miss(best) > 0; ++i) {
    const double middle = std::sqrt(low * high);
    Sequence sequence = viterbi.sequence(middle);
    (sequence.changes.size() > number ? low : high) = middle;
    if (miss(sequence) < miss(best)) best = std::move(sequence);
  }
  return best;
}

/// Best monotonic staircase (up or down). One that reverses is preferred only if its misfit beyond white
/// noise is far smaller, because a draft as large as a step looks like a step up and down.
Sequence best_sequence(const Blocks& blocks, const StepSearch& search, double penalty, double noise_misfit) {
  constexpr double kFarSmallerShare = 0.35;
  const auto of = [&](Direction direction) {
    Viterbi viterbi(blocks, search.min_dwell_s, direction);
    return search.steps > 0 ? sequence_of_number(viterbi, search.steps, penalty) : viterbi.sequence(penalty);
  };
  const auto unexplained = [&](const Sequence& sequence) {
    return std::max(0.0, sequence.misfit - noise_misfit);
  };
  const auto full = [&](const Sequence& sequence) {
    return sequence.misfit + penalty * static_cast<double>(sequence.changes.size());
  };
  Sequence one_way = of(Direction::kUp);
  Sequence down = of(Direction::kDown);
  if (full(down) < full(one_way)) one_way = std::move(down);
  Sequence either = of(Direction::kEither);
  const bool turns =
      unexplained(either) < kFarSmallerShare * unexplained(one_way) && full(either) < full(one_way);
  return turns ? either : one_way;
}

std::size_t sample_at(const HeightTrack& track, double time_s) {
  return static_cast<std::size_t>(std::lower_bound(track.times_s.begin(), track.times_s.end(), time_s) -
                                  track.times_s.begin());
}

/// Time of a step between two samples, within kReachS of `change_s`, that fits the levels on both sides best;
/// these reach from begin_s to end_s.
double refined(const HeightTrack& track, double begin_s, double change_s, double end_s) {
  constexpr double kReachS = 2.0;
  constexpr double kSideS = 10.0;  // drift dominates further away
  const std::size_t begin = sample_at(track, std::max(begin_s, change_s - kSideS));
  const std::size_t end = sample_at(track, std::min(end_s, change_s + kSideS));
  if (end < begin + 2) return change_s;
  const double base_m = track.heights_m[begin];
  double total = 0.0;
  for (std::size_t i = begin; i < end; ++i) total += track.heights_m[i] - base_m;
  // Least squares about two means maximises sum_before^2 / n_before + sum_after^2 / n_after.
  double before = 0.0;
  double best = -1.0;
  double best_s = change_s;
  for (std::size_t i = begin + 1; i < end; ++i) {
    before += track.heights_m[i - 1] - base_m;
    if (std::abs(track.times_s[i] - change_s) > kReachS) continue;
    const double explained = before * before / static_cast<double>(i - begin) +
                             (total - before) * (total - before) / static_cast<double>(end - i);
    if (explained <= best) continue;
    best = explained;
    best_s = 0.5 * (track.times_s[i - 1] + track.times_s[i]);
  }
  return best_s;
}

}  // namespace

FoundSteps find_steps(const HeightTrack& track, const StepSearch& search) {
  FoundSteps found;
  if (track.times_s.size() < 3 || !(track.times_s.back() > track.times_s.front())) return found;
  const double density = noise_density(track, search.step_m);
  found.uncertainty_s = std::sqrt(26.0) * density;
  const Blocks blocks = blocks_of(track, search.step_m);
  // A detour to another level and back costs two penalties. They must stay below the cost of missing a true
  // level: a deviation of one step for min_dwell_s. They must exceed what a detour can gain on white noise:
  // over T seconds z sqrt(4 density T) - T, at most z^2 density.
  constexpr double kNoiseSigmas = 3.5;
  const double penalty = std::max(0.4 * search.min_dwell_s, 0.5 * kNoiseSigmas * kNoiseSigmas * density);
  const double span_s = track.times_s.back() - track.times_s.front();
  const double noise_misfit = span_s * density / blocks.length_s;
  std::vector<double>& times = found.times_s;
  for (const std::size_t change : best_sequence(blocks, search, penalty, noise_misfit).changes) {
    times.push_back(blocks.begins_s[change]);
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = refined(track, i == 0 ? track.times_s.front() : times[i - 1], times[i],
                       i + 1 < times.size() ? times[i + 1] : track.times_s.back());
  }
  return found;
}

}  // namespace isobar
