// SPDX-License-Identifier: BSD-3-Clause
// Offset of a device's clock to the host's.
#pragma once

#include <cstdint>

namespace isobar {

/// Limits of ClockAnchor.
struct ClockAnchorConfig {
  /// Period after which the device's clock wraps to 0 [ns]; 0: never. Velodyne: one hour.
  std::int64_t period_ns = 0;
  /// Largest relative rate error of the two clocks [1e-6]: crystals of sensors and PCs stay below 50 each.
  std::int64_t max_drift_ppm = 100;
  /// Largest jitter [ns]: beyond it, either clock has stepped or a stamp is wrong.
  std::int64_t step_threshold_ns = 50'000'000;
  /// Largest regular interval between successive samples [ns].
  std::int64_t max_cadence_ns = 500'000'000;
  /// Duration on both clocks after which a changed offset is accepted [ns].
  std::int64_t confirm_ns = 500'000'000;
  /// Number of successive samples after which it is accepted if no delay can explain it: samples arrive
  /// early, or the device's stamps stepped.
  std::int64_t confirm_samples = 4;
  /// Largest earliness that lowers the offset at once [ns]; a larger one needs confirm_samples, so that one
  /// wrong host stamp cannot pull the offset down.
  std::int64_t max_early_ns = 2'000'000;
};

/// Maps a device's clock to the host's from pairs (device stamp, host receive stamp).
///
/// Minimum filter: transport only delays, so the smallest difference host - device is the best estimate of
/// the offset. It rises by the drift allowance only and falls as soon as an earlier packet proves it too
/// large (the clock filter of RFC 5905 section 10, with linear forgetting instead of a register), so single
/// late packets change nothing. A step of the device's clock re-anchors at once; it is distinguished from a
/// wrong host stamp by which clock stayed regular. A lasting step of the host's clock re-anchors after
/// confirm_ns. Integer arithmetic only: bit-identical on every machine.
class ClockAnchor {
 public:
  explicit ClockAnchor(const ClockAnchorConfig& config = {});

  /// Result of add().
  enum class Finding : std::uint8_t {
    kFirst,        ///< the first pair: anchored
    kContinuous,   ///< regular
    kBackward,     ///< device stamp older than the newest by less than max_cadence_ns: reordered
    kHostSuspect,  ///< host stamp off by more than step_threshold_ns: offset kept
    kStep,         ///< one of the clocks stepped: re-anchored
  };

  /// Takes one pair. device_ns: the device's stamp, 0 … period_ns - 1 if it has a period.
  Finding add(std::int64_t device_ns, std::int64_t host_ns);

  /// Unwrapped device time of the last add(): continuous across the period, arbitrary start [ns].
  [[nodiscard]] std::int64_t device_unwrapped_ns() const { return device_ns_; }
  /// Maps an unwrapped device time to the host's clock [ns].
  [[nodiscard]] std::int64_t to_host_ns(std::int64_t unwrapped_ns) const { return unwrapped_ns + offset_ns_; }

  /// Host's clock minus unwrapped device time [ns].
  [[nodiscard]] std::int64_t offset_ns() const { return offset_ns_; }
  /// Device's clock minus host's [ns], less the shortest transport, which nobody knows; of a clock that wraps the
  /// smallest such difference.
  [[nodiscard]] std::int64_t device_ahead_ns() const;
  [[nodiscard]] std::uint64_t steps() const { return steps_; }  ///< re-anchorings since the start

 private:
  Finding first(std::int64_t device_ns, std::int64_t host_ns);
  Finding re_anchor(std::int64_t offset_ns, std::int64_t host_ns);
  Finding suspect(std::int64_t difference_ns, std::int64_t host_ns, bool device_regular);
  void follow(std::int64_t difference_ns, std::int64_t elapsed_ns);

  ClockAnchorConfig config_;
  bool anchored_ = false;
  std::int64_t raw_ns_ = 0;          // last device stamp as given
  std::int64_t device_ns_ = 0;       // the same, unwrapped
  std::int64_t newest_ns_ = 0;       // newest unwrapped device stamp so far
  std::int64_t newest_host_ns_ = 0;  // its host stamp
  std::int64_t offset_ns_ = 0;
  std::int64_t drift_rest_ = 0;  // remainder of the integer drift allowance [1e-6 ns]
  // A changed offset under observation.
  std::int64_t candidate_samples_ = 0;
  std::int64_t candidate_low_ns_ = 0;
  std::int64_t candidate_high_ns_ = 0;
  std::int64_t candidate_device_ns_ = 0;
  std::int64_t candidate_host_ns_ = 0;
  bool candidate_is_delay_ = false;
  std::int64_t early_samples_ = 0;
  std::int64_t early_highest_ns_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace isobar
