// SPDX-License-Identifier: BSD-3-Clause
// Admission of a base station's samples, received over DDS or as datagrams.
#pragma once

#include <array>
#include <cstdint>

#include "core/samples.hpp"
#include "core/time/cadence.hpp"
#include "core/time/clock_anchor.hpp"
#include "core/time/system_clock_watch.hpp"

namespace isobar {

/// Limits of the admission.
struct BaseStationConfig {
  /// Largest transport delay of a sample [ns]. Weather moves at most 0.15 Pa (1.3 cm) meanwhile, and the
  /// altimeter holds the base's pressure for longer anyway.
  std::int64_t max_age_ns = 5'000'000'000;
  /// Largest apparent negative delay [ns]: a sample cannot arrive before it was measured, so beyond this the
  /// base's clock was set.
  std::int64_t max_early_ns = 50'000'000;
  /// Confirmation of a new clock or a new sender: this many samples that agree on one clock, while no sample
  /// of the known sender and clock arrives. So a single message cannot replace a base station.
  std::uint32_t confirm_samples = 3;
  /// Largest disagreement of these samples [ns]: network jitter.
  std::int64_t agreement_ns = 250'000'000;
  /// Shortest duration of these samples, on both clocks [ns].
  std::int64_t confirm_ns = 500'000'000;
  /// Silence after which a sender that was never heard beside the one in use, such as a restart of it,
  /// replaces it [ns]. An ended sender is replaced at once.
  std::int64_t replace_ns = 5'000'000'000;
  /// Silence after which another base station of the same name, heard beside the one in use, replaces it
  /// [ns]. Longer than the altimeter's default time-out: the altimeter reports the loss before it receives
  /// samples of the other one.
  std::int64_t takeover_ns = 15'000'000'000;
};

/// Verdict on one sample.
enum class BaseVerdict : std::uint8_t {
  kAccepted,
  kRepeated,     ///< accepted before: a copy or a replay
  kOutdated,     ///< older than the newest: overtaken in transport, or replayed
  kTooOld,       ///< transport delay above max_age_ns
  kAhead,        ///< stamp in the future: the base's clock was set, or the stamp is absurd
  kOtherSender,  ///< another base station of the same name, while the first one is alive
  kUnconfirmed,  ///< of a new sender that is not yet confirmed, after the old one was lost
};

/// Status of a stream: plain values, trivially copyable.
struct BaseStationStatus {
  std::array<std::uint64_t, 7> samples{};  ///< by BaseVerdict
  std::uint64_t outages = 0;               ///< silences that ended
  std::uint64_t restarts = 0;              ///< replacements of a lost sender
  std::uint64_t returns = 0;               ///< returns of a replaced sender, which is used again
  std::uint64_t clock_steps = 0;           ///< settings of the base's clock
  std::int64_t last_ns = 0;         ///< arrival of the newest accepted sample, robot clock; 0: none yet
  std::int64_t interval_ns = 0;     ///< learnt sample interval; 0: unknown
  std::int64_t limit_ns = 0;        ///< longest pause that is not a loss
  std::int64_t clock_ahead_ns = 0;  ///< base's clock minus robot's clock
  std::int64_t rival_ns = 0;        ///< last sample of another base of the same name, robot clock; 0: never
  bool left = false;                ///< its sender has ended

  [[nodiscard]] std::uint64_t count(BaseVerdict verdict) const noexcept {
    return samples[static_cast<std::size_t>(verdict)];
  }
  [[nodiscard]] bool heard() const noexcept { return count(BaseVerdict::kAccepted) > 0; }
  [[nodiscard]] bool lost(std::int64_t now_ns) const noexcept {
    return heard() && (left || now_ns - last_ns > limit_ns);
  }
};

/// Filter of one base station's samples: maps their stamps to the robot's clock and refuses delayed, repeated
/// and replayed ones.
///
/// Each sender has its own clock, tied to the robot's by a ClockAnchor; stamps must ascend on it. Samples
/// that contradict it are refused until enough of them agree on another clock while none fits the known one:
/// then the base's clock was set. A replay is therefore refused while the base is alive, and at any time if
/// its samples are among the last 4000 or more, which are remembered. Not detectable: a replay of never
/// received samples while there is no base, which looks like a base with a wrong clock.
///
/// The first sender is used; a new one replaces it after it has ended or was silent for replace_ns. A sender
/// heard beside it is another base station at another place: its samples are never mixed in, and it replaces
/// the one in use only after a silence of takeover_ns. A replaced sender that returns on its known clock is
/// used again at once, so that no other one can lock it out. No allocation; single thread.
class BaseStationStream {
 public:
  explicit BaseStationStream(const BaseStationConfig& config = {});

  /// @param sender identity of the sender: a DDS writer, an address
  /// @param sample plausible, stamp on the sender's clock; if kAccepted, its stamp is replaced by the robot's
  ///        clock, strictly ascending
  /// @param receive_ns time of arrival, robot clock
  /// @param system steps of this machine's system clock, which senders on it share; null: unknown
  BaseVerdict check(std::uint64_t sender, PressureSample& sample, std::int64_t receive_ns,
                    const SystemClockWatch* system = nullptr) noexcept;

  /// The sender has ended (a DDS writer was deleted).
  void sender_gone(std::uint64_t sender) noexcept;

  [[nodiscard]] bool lost(std::int64_t now_ns) const noexcept { return left_ || cadence_.silent(now_ns); }
  [[nodiscard]] std::uint64_t sender() const noexcept { return clock_.sender; }
  [[nodiscard]] BaseStationStatus status() const noexcept;

 private:
  /// Clock of a base station, estimated from its samples.
  struct Clock {
    ClockAnchor anchor;
    SenderClock steps;
    std::int64_t first_ns = 0;          // base's clock
    std::int64_t first_receive_ns = 0;  // robot's
    std::int64_t newest_ns = 0;
    std::int64_t newest_receive_ns = 0;
    std::uint64_t sender = 0;
    std::uint32_t samples = 0;

    void add(std::int64_t stamp_ns, std::int64_t receive_ns) noexcept;
    /// Transport delay of a sample beyond the smallest seen, by this clock; negative: early [ns].
    [[nodiscard]] std::int64_t lateness_ns(std::int64_t stamp_ns, std::int64_t receive_ns) const noexcept {
      return receive_ns - stamp_ns - anchor.offset_ns();
    }
  };
  /// Fingerprints of accepted samples with equal low bits; a ring, the oldest is overwritten.
  struct Bucket {
    std::array<std::uint64_t, 8> prints{};
    std::uint8_t next = 0;
  };
  static constexpr std::size_t kBuckets = 1024;
  static constexpr std::size_t kRivals = 4;
  /// Sender other than the one in use: a restart of that one, or another base station beside it. is_beside is
  /// set once the one in use is heard again.
  struct Rival {
    std::uint64_t sender = 0;
    bool known = false;
    bool is_beside = false;
  };

  [[nodiscard]] BaseVerdict verdict_on(std::uint64_t sender, const PressureSample& sample,
                                       std::uint64_t print, std::int64_t receive_ns) noexcept;
  /// The stamp without the steps of the system clock that this sender shares.
  [[nodiscard]] std::int64_t without_steps_ns(std::uint64_t sender, std::int64_t stamp_ns,
                                              std::int64_t receive_ns,
                                              const SystemClockWatch& system) noexcept;
  [[nodiscard]] bool returns(std::uint64_t sender, std::int64_t stamp_ns,
                             std::int64_t receive_ns) const noexcept;
  void take_back() noexcept;
  void replace(bool is_new) noexcept;
  [[nodiscard]] bool may_follow(std::uint64_t sender, std::int64_t receive_ns) const noexcept;
  [[nodiscard]] const Rival* find_rival(std::uint64_t sender) const noexcept;
  void note_rival(std::uint64_t sender, std::int64_t receive_ns) noexcept;
  [[nodiscard]] BaseVerdict judge(const Clock& clock, std::int64_t stamp_ns,
                                  std::int64_t receive_ns) const noexcept;
  [[nodiscard]] bool confirms(std::uint64_t sender, std::int64_t stamp_ns, std::int64_t receive_ns) noexcept;
  void accept(PressureSample& sample, std::uint64_t print, std::int64_t receive_ns) noexcept;
  [[nodiscard]] static std::uint64_t fingerprint(const PressureSample& sample) noexcept;
  [[nodiscard]] bool remembers(std::uint64_t print) const noexcept;
  void remember(std::uint64_t print) noexcept;

  BaseStationConfig config_;
  Clock clock_;
  Clock candidate_;
  Clock previous_;  // of the replaced sender; without samples: none
  Cadence cadence_;
  BaseStationStatus status_;
  bool left_ = false;
  std::int64_t newest_robot_ns_ = 0;
  std::array<Rival, kRivals> rivals_{};
  std::size_t next_rival_ = 0;
  std::array<Bucket, kBuckets> memory_{};
};

}  // namespace isobar
