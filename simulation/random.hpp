// SPDX-License-Identifier: BSD-3-Clause
// Reproducible random numbers. The distributions are implemented here, because those of the standard library
// are implementation-defined: the same seed would give other numbers with another library.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace isobar::simulation {

/// xoshiro256++ of Blackman and Vigna (2019), seeded by SplitMix64 as they recommend.
class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (auto& word : state_) word = split_mix(seed);
  }

  /// Independent stream: its numbers depend on (seed, name, index) only, not on what other streams have
  /// drawn. Sensors can therefore be simulated in any order and on any thread.
  Random(std::uint64_t seed, std::string_view name, std::uint64_t index = 0)
      : Random(mix(mix(seed, hash(name)), index)) {}

  [[nodiscard]] std::uint64_t next() {
    const std::uint64_t result = rotate_left(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = rotate_left(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [low, high].
  [[nodiscard]] int integer(int low, int high) {
    return low + static_cast<int>(uniform() * static_cast<double>(high - low + 1));
  }
  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }
  /// -1 or +1.
  [[nodiscard]] double sign() { return chance(0.5) ? 1.0 : -1.0; }

  /// Normal with mean 0 and standard deviation `sigma`, by the method of Box and Muller (1958).
  [[nodiscard]] double normal(double sigma = 1.0) {
    if (has_spare_) {
      has_spare_ = false;
      return sigma * spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return sigma * radius * std::cos(angle);
  }

  /// Exponential with the given mean.
  [[nodiscard]] double exponential(double mean) { return -mean * std::log(1.0 - uniform()); }

 private:
  static std::uint64_t rotate_left(std::uint64_t value, unsigned bits) {
    return (value << bits) | (value >> (64U - bits));
  }
  static std::uint64_t split_mix(std::uint64_t& state) {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }
  static std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t state = a ^ rotate_left(b, 32);
    return split_mix(state) ^ b;
  }
  /// FNV-1a.
  static std::uint64_t hash(std::string_view text) {
    std::uint64_t value = 0xCBF29CE484222325ULL;
    for (const char letter : text) value = (value ^ static_cast<unsigned char>(letter)) * 0x100000001B3ULL;
    return value;
  }

  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// First-order Gauss-Markov process: exponentially correlated noise with standard deviation `sigma` and time
/// constant `tau_s`, discretised exactly (Ornstein-Uhlenbeck process).
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double tau_s, Random random)
      : sigma_(sigma), tau_s_(tau_s), random_(random), value_(random_.normal(sigma)) {}

  /// Advances by `dt_s` (>= 0) and returns the new value.
  double step(double dt_s) {
    const double keep = std::exp(-dt_s / tau_s_);
    value_ = keep * value_ + random_.normal(sigma_ * std::sqrt(1.0 - keep * keep));
    return value_;
  }

 private:
  double sigma_;
  double tau_s_;
  Random random_;
  double value_;
};

}  // namespace isobar::simulation
