// SPDX-License-Identifier: BSD-3-Clause
// A text protocol over UDP through which a microcontroller, or a driver that knows nothing of DDS, feeds
// samples.
//
// One datagram holds one or more lines; a line ends with \n or \r\n, the last one may lack it. A line is one
// sample:
//
//   imu,SEQ,t_ns,gx,gy,gz,ax,ay,az[,qw,qx,qy,qz]   rad/s, m/s^2, attitude of the IMU where it computes one
//   baro,SEQ,t_ns,pressure_pa,temperature_c        the robot's barometer; temperature nan: none
//   base,SEQ,t_ns,pressure_pa,temperature_c        the base station's barometer
//   wheel,SEQ,t_ns,vx,vy,wz                        m/s, m/s, rad/s: twist of base_link in base_link
//
// SEQ counts the lines of that kind, 0 … 2^32-1, and wraps; 0 after another number is a restarted sender.
// t_ns: when it was measured, on the sender's clock, int64; 0: unknown, the time of receipt is taken.
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
/// Most bytes in one datagram: an Ethernet frame's worth, so that nothing is fragmented.
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
  kUnknownKind,  ///< the first word is none of the four
  kMalformed,    ///< not numbers, or another number of fields
  kImplausible,  ///< core/plausibility.hpp says no
};

/// Parses one line without its line end. Allocates nothing.
LineStatus parse_line(std::string_view line, Sample& sample);

/// Writes one line with its newline. out: at least kMaxLineBytes. Returns the length. Exact: parsing gives
/// the same bits.
std::size_t format_line(const Sample& sample, std::span<char> out);

/// What came of the lines so far; one writer.
struct Counters {
  std::uint64_t datagrams = 0;
  std::uint64_t samples[kKinds] = {};     // NOLINT(modernize-avoid-c-arrays): by Kind
  std::uint64_t lost[kKinds] = {};        // NOLINT(modernize-avoid-c-arrays): from gaps in SEQ
  std::uint64_t duplicated[kKinds] = {};  // NOLINT(modernize-avoid-c-arrays)
  std::uint64_t reordered[kKinds] = {};   // NOLINT(modernize-avoid-c-arrays)
  std::uint64_t malformed = 0;
  std::uint64_t implausible = 0;
  std::uint64_t unknown_kind = 0;
};

/// Takes datagrams apart and watches the sequence numbers.
///
///     parser.begin(bytes);
///     while (parser.next(sample)) { … }
class DatagramParser {
 public:
  void begin(std::span<const std::uint8_t> payload);
  /// The next good sample of the datagram; duplicates are left out, reordered samples are not. False at the
  /// end.
  bool next(Sample& sample);
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
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
