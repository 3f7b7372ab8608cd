// SPDX-License-Identifier: BSD-3-Clause
// What may be believed of a base station's messages, whichever way they come: over DDS or as datagrams.
#pragma once

#include <array>
#include <cstdint>

#include "core/samples.hpp"
#include "core/time/cadence.hpp"
#include "core/time/clock_anchor.hpp"

namespace isobar {

struct BaseStationConfig {
  /// A sample that took longer than this on its way is refused [ns]. Weather moves 0.15 Pa (1.3 cm) meanwhile
  /// at the most, and the altimeter holds the base's pressure for longer than this anyway.
  std::int64_t max_age_ns = 5'000'000'000;
  /// A sample cannot come before it was measured: earlier by more than this, the base's clock was set [ns].
  std::int64_t max_early_ns = 50'000'000;
  /// Samples off the known clock, or of a new sender, are believed once so many of them agree on one clock …
  std::uint32_t confirm_samples = 3;
  /// … within this [ns] …
  std::int64_t agreement_ns = 250'000'000;
  /// … for this long on both clocks [ns], and none of the known sender and clock has come meanwhile.
  std::int64_t confirm_ns = 500'000'000;
  /// Another base station that was heard beside the one in use takes its place after this silence [ns].
  /// Longer than the altimeter's time-out as it is by default: it has then said that the base is lost, and
  /// takes the other one as a return.
  std::int64_t takeover_ns = 15'000'000'000;
};

/// What became of one sample.
enum class BaseVerdict : std::uint8_t {
  kAccepted,
  kRepeated,     ///< this very sample came before: a copy, or a replay of what was sent earlier
  kOutdated,     ///< measured before the newest one: overtaken on its way, or replayed
  kTooOld,       ///< was on its way for more than max_age_ns
  kAhead,        ///< from the future: the base's clock was set, or the stamp is absurd
  kOtherSender,  ///< another base station of the same name, while the first one is alive
  kUnconfirmed,  ///< a new sender in place of one that has gone, seen too briefly to be believed
};

/// What a stream says of itself: plain values, for a SeqLock.
struct BaseStationStatus {
  std::array<std::uint64_t, 7> samples{};  ///< by BaseVerdict
  std::uint64_t outages = 0;               ///< silences that ended
  std::uint64_t restarts = 0;              ///< another sender took the place of one that had gone
  std::uint64_t clock_steps = 0;           ///< the base's clock was set
  std::int64_t last_ns = 0;                ///< robot clock, when the newest accepted one came; 0: none yet
  std::int64_t interval_ns = 0;            ///< learnt; 0: not known yet
  std::int64_t limit_ns = 0;               ///< a longer pause is a loss
  std::int64_t clock_ahead_ns = 0;         ///< how far the base's clock is ahead of the robot's
  std::int64_t rival_ns = 0;  ///< robot clock, when another base of the same name was heard last; 0: never
  bool left = false;          ///< its sender has said goodbye

  [[nodiscard]] std::uint64_t count(BaseVerdict verdict) const noexcept {
    return samples[static_cast<std::size_t>(verdict)];
  }
  [[nodiscard]] bool heard() const noexcept { return count(BaseVerdict::kAccepted) > 0; }
  [[nodiscard]] bool lost(std::int64_t now_ns) const noexcept {
    return heard() && (left || now_ns - last_ns > limit_ns);
  }
};

/// One base station's samples: maps their stamps to the robot's clock and refuses what is not of now.
///
/// Each sender has a clock of its own, tied by a ClockAnchor. Samples must go forward on that clock. Those
/// that do not fit it are refused, until enough of them agree on another clock while none fits any more: then
/// the base's clock was set. A replay cannot get in that way as long as the base is alive, nor with samples
/// that this stream remembers (the last 4000 or more). What it cannot tell from a base with a wrong clock is
/// a replay of samples that it never saw, while there is no base.
///
/// The sender that was heard first is used; a new one follows it when it has gone. One that was heard beside
/// it is another base station at another place, and is not mixed with it. Allocates nothing; one thread.
class BaseStationStream {
 public:
  explicit BaseStationStream(const BaseStationConfig& config = {});

  /// @param sender whatever tells senders apart: a DDS writer, an address
  /// @param sample plausible, its stamp on the sender's clock; with kAccepted on the robot's, and newer than
  ///        all before
  /// @param receive_ns when it came, robot clock
  BaseVerdict check(std::uint64_t sender, PressureSample& sample, std::int64_t receive_ns) noexcept;

  /// That sender has ended, for all that is known.
  void sender_gone(std::uint64_t sender) noexcept;

  [[nodiscard]] bool lost(std::int64_t now_ns) const noexcept { return left_ || cadence_.silent(now_ns); }
  [[nodiscard]] std::uint64_t sender() const noexcept { return clock_.sender; }
  [[nodiscard]] BaseStationStatus status() const noexcept;

 private:
  /// One clock of a base station, as its samples show it.
  struct Clock {
    ClockAnchor anchor;
    std::int64_t first_ns = 0;          // base's clock
    std::int64_t first_receive_ns = 0;  // robot's
    std::int64_t newest_ns = 0;
    std::int64_t newest_receive_ns = 0;
    std::uint64_t sender = 0;
    std::uint32_t samples = 0;

    void add(std::int64_t stamp_ns, std::int64_t receive_ns) noexcept;
    /// How late a sample is by this clock, negative: early [ns].
    [[nodiscard]] std::int64_t lateness_ns(std::int64_t stamp_ns, std::int64_t receive_ns) const noexcept {
      return receive_ns - stamp_ns - anchor.offset_ns();
    }
  };
  /// Fingerprints of accepted samples whose last bits are the same; the oldest makes room.
  struct Bucket {
    std::array<std::uint64_t, 8> prints{};
    std::uint8_t next = 0;
  };
  static constexpr std::size_t kBuckets = 1024;
  static constexpr std::size_t kRivals = 4;
  /// Another sender than the one in use. Whether it is a restart of that one or another base station beside
  /// it shows when the one in use is heard again.
  struct Rival {
    std::uint64_t sender = 0;
    bool known = false;
    bool is_beside = false;
  };

  [[nodiscard]] BaseVerdict verdict_on(std::uint64_t sender, const PressureSample& sample,
                                       std::uint64_t print, std::int64_t receive_ns) noexcept;
  [[nodiscard]] bool may_follow(std::uint64_t sender, std::int64_t receive_ns) const noexcept;
  [[nodiscard]] const Rival* find_rival(std::uint64_t sender) const noexcept;
  void note_rival(std::uint64_t sender, std::int64_t receive_ns) noexcept;
  [[nodiscard]] BaseVerdict judge(std::int64_t stamp_ns, std::int64_t receive_ns) const noexcept;
  [[nodiscard]] bool confirms(std::uint64_t sender, std::int64_t stamp_ns, std::int64_t receive_ns) noexcept;
  void accept(PressureSample& sample, std::uint64_t print, std::int64_t receive_ns) noexcept;
  [[nodiscard]] static std::uint64_t fingerprint(const PressureSample& sample) noexcept;
  [[nodiscard]] bool remembers(std::uint64_t print) const noexcept;
  void remember(std::uint64_t print) noexcept;

  BaseStationConfig config_;
  Clock clock_;
  Clock candidate_;
  Cadence cadence_;
  BaseStationStatus status_;
  bool left_ = false;
  std::int64_t newest_robot_ns_ = 0;
  std::array<Rival, kRivals> rivals_{};
  std::size_t next_rival_ = 0;
  std::array<Bucket, kBuckets> memory_{};
};

}  // namespace isobar
