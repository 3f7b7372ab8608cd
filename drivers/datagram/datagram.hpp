// SPDX-License-Identifier: BSD-3-Clause
// Text protocol over UDP for samples from a microcontroller, or from a driver without DDS.
//
// A datagram holds one or more lines, a line one sample. Lines end with \n or \r\n (optional on the last
// one):
//
//   imu,SEQ,t_ns,gx,gy,gz,ax,ay,az[,qw,qx,qy,qz]   rad/s, m/s^2, attitude if the IMU computes one
//   baro,SEQ,t_ns,pressure_pa,temperature_c        the robot's barometer; temperature nan: no thermometer
//   base,SEQ,t_ns,pressure_pa,temperature_c        the base station's barometer
//   wheel,SEQ,t_ns,vx,vy,wz                        m/s, m/s, rad/s: twist of base_link in base_link
//
// SEQ: number of lines of that kind sent before, 0 … 2^32-1, wraps; an unexpected 0 is a restarted sender.
// t_ns: time of measurement on the sender's clock, int64; 0: unknown, replaced with the time of receipt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/samples.hpp"

namespace isobar::datagram {

inline constexpr std::uint16_t kDefaultPort = 7373;
/// Longest line that the formatter writes, newline included.
inline constexpr std::size_t kMaxLineBytes = 384;
/// Largest datagram: the payload of one Ethernet frame, so that IP does not fragment it.
inline constexpr std::size_t kMaxDatagramBytes = 1472;

enum class Kind : std::uint8_t { kImu, kPressure, kBasePressure, kWheel };
inline constexpr std::size_t kKinds = 4;

/// One parsed line. Only the member that `kind` names is valid.
struct Sample {
  Kind kind = Kind::kImu;
  std::uint32_t sequence = 0;
  ImuSample imu;
  PressureSample pressure;
  WheelSample wheel;

  [[nodiscard]] std::int64_t stamp_ns() const;
  void set_stamp_ns(std::int64_t stamp_ns);
};

enum class LineStatus : std::uint8_t {
  kOk,
  kUnknownKind,  ///< the first word is not imu, baro, base or wheel
  kMalformed,    ///< a field is not a number, or the number of fields is wrong
  kImplausible,  ///< a value lies outside its plausible range (core/plausibility.hpp)
};

/// Parses one line without its line end. Allocates nothing.
LineStatus parse_line(std::string_view line, Sample& sample);

/// Writes one line with its newline. Lossless: parsing gives the same bits.
/// @param out at least kMaxLineBytes
/// @return length [bytes]
std::size_t format_line(const Sample& sample, std::span<char> out);

/// What becomes of a line of a good format.
enum class Admission : std::uint8_t {
  kSkip,             ///< skipped as if it had not come; its sequence number counts for nothing
  kInSequence,       ///< used if its sequence number is new
  kWithoutSequence,  ///< used; its sequence number is none of the stream's
};

/// Counters since construction; one writer.
struct Counters {
  std::uint64_t datagrams = 0;
  std::uint64_t samples[kKinds] = {};     // NOLINT(modernize-avoid-c-arrays): by Kind
  std::uint64_t lost[kKinds] = {};        // NOLINT(modernize-avoid-c-arrays): from gaps in SEQ
  std::uint64_t duplicated[kKinds] = {};  // NOLINT(modernize-avoid-c-arrays)
  std::uint64_t reordered[kKinds] = {};   // NOLINT(modernize-avoid-c-arrays)
  std::uint64_t restarts[kKinds] = {};    // NOLINT(modernize-avoid-c-arrays): SEQ began anew
  std::uint64_t malformed = 0;
  std::uint64_t implausible = 0;
  std::uint64_t unknown_kind = 0;
};

/// Parser of datagrams; checks the sequence numbers.
///
///     parser.begin(bytes);
///     while (parser.next(sample)) { … }
class DatagramParser {
 public:
  void begin(std::span<const std::uint8_t> payload);
  /// The next good sample of the datagram, reordered ones included, duplicates skipped; false at the end.
  bool next(Sample& sample) {
    return next(sample, [](const Sample&, LineStatus) { return Admission::kInSequence; });
  }
  /// As above.
  /// @param admit called with each line of a good format and its status, kOk or kImplausible; returns its
  ///        Admission
  template <class Admit>
  bool next(Sample& sample, const Admit& admit) {
    LineStatus status = LineStatus::kOk;
    while (next_line(sample, status)) {
      const Admission admission = admit(sample, status);
      if (admission == Admission::kSkip) continue;
      // The sequence of implausible lines, too: received, so not lost.
      const bool is_new = admission == Admission::kWithoutSequence || follow_sequence(sample);
      if (status == LineStatus::kImplausible) {
        ++counters_.implausible;
      } else if (is_new) {
        ++counters_.samples[static_cast<std::size_t>(sample.kind)];
        return true;
      }
    }
    return false;
  }
  /// Forgets the sequence number of one stream: another sender follows.
  void restart(Kind kind) { streams_[static_cast<std::size_t>(kind)] = {}; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  /// The next line whose format is good; counts the others.
  bool next_line(Sample& sample, LineStatus& status);
  bool follow_sequence(const Sample& sample);

  struct Stream {
    bool started = false;
    std::uint32_t newest = 0;
    std::uint64_t seen = 0;  ///< bit i: newest - i was received
  };
  std::string_view rest_;
  Counters counters_;
  Stream streams_[kKinds];  // NOLINT(modernize-avoid-c-arrays)
};

}  // namespace isobar::datagram
