// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar {

/// How a device's clock is tied to the host's.
struct ClockAnchorConfig {
  /// The device's clock starts again after this long [ns]; 0: never. Velodyne: one hour.
  std::int64_t period_ns = 0;
  /// Largest rate error between the two clocks [parts per million]; crystals of sensors and PCs stay below 50
  /// each.
  std::int64_t max_drift_ppm = 100;
  /// Samples off by more than this are not jitter: either clock has stepped, or the stamp is wrong [ns].
  std::int64_t step_threshold_ns = 50'000'000;
  /// Steps of one clock between neighbouring samples up to this long are the normal cadence [ns].
  std::int64_t max_cadence_ns = 500'000'000;
  /// A changed offset is believed after it has been seen on both clocks for this long [ns] …
  std::int64_t confirm_ns = 500'000'000;
  /// … or, where delay cannot explain it (samples come early, or the device broke its own cadence), after
  /// this many samples in a row.
  std::int64_t confirm_samples = 4;
  /// Samples that come earlier than the offset allows by up to this lower it at once, others after
  /// confirm_samples, so that one wrong host stamp cannot pull the offset down [ns].
  std::int64_t max_early_ns = 2'000'000;
};

/// Maps a device's clock to the host's from pairs (device stamp, host receive stamp).
///
/// Transport only ever delays, so the smallest difference host - device is the best estimate of the offset;
/// it may rise by the drift allowance only, and falls as soon as earlier packets prove it too large (the
/// minimum filter of network time protocols, RFC 5905 section 10, with a linear forgetting in place of a
/// register). One-off late packets therefore change nothing. A step of the device's clock is told from a
/// wrong host stamp by which of the two clocks kept its cadence, and re-anchors at once; a lasting step of
/// the host's clock re-anchors after confirm_ns. Integer arithmetic only: the same input gives the same
/// output on every machine.
class ClockAnchor {
 public:
  explicit ClockAnchor(const ClockAnchorConfig& config = {});

  /// What add() found.
  enum class Finding : std::uint8_t {
    kFirst,        ///< the first pair: anchored
    kContinuous,   ///< the usual
    kBackward,     ///< the device stamp is older than the newest one, by less than max_cadence_ns: reordered
    kHostSuspect,  ///< the host stamp is off by more than step_threshold_ns; the offset was kept
    kStep,         ///< one of the clocks stepped: re-anchored
  };

  /// Feeds one pair. device_ns: the device's stamp, 0 … period_ns - 1 if it has a period.
  Finding add(std::int64_t device_ns, std::int64_t host_ns);

  /// The device time of the last add() without wraps: continuous across the period, arbitrary start [ns].
  [[nodiscard]] std::int64_t device_unwrapped_ns() const { return device_ns_; }
  /// Maps an unwrapped device time to the host's clock [ns].
  [[nodiscard]] std::int64_t to_host_ns(std::int64_t unwrapped_ns) const { return unwrapped_ns + offset_ns_; }

  [[nodiscard]] bool anchored() const { return anchored_; }
  [[nodiscard]] std::int64_t offset_ns() const { return offset_ns_; }
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
  std::int64_t drift_rest_ = 0;  // what the integer drift allowance has not yet used [1e-6 ns]
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
