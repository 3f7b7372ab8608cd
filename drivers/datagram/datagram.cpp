// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/datagram/datagram.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/plausibility.hpp"

namespace isobar::datagram {
namespace {

constexpr std::array<std::string_view, kKinds> kWords{"imu", "baro", "base", "wheel"};
/// Number of values after SEQ and t_ns, by kind; an IMU may add four (attitude).
constexpr std::array<std::size_t, kKinds> kValues{6, 2, 2, 3};
constexpr std::size_t kMaxValues = 10;
/// Largest step back of SEQ by reordering; a larger one is a restarted sender. Bits of Stream::seen.
constexpr std::uint32_t kReorderWindow = 64;
/// Largest step forward of SEQ that counts as loss; a larger one is a restarted sender.
constexpr std::uint32_t kMaxLoss = 1'000'000;

std::string_view next_field(std::string_view& rest) {
  const auto comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  return field;
}

template <typename Number>
bool parse(std::string_view text, Number& value) {
  while (!text.empty() && text.front() == ' ') {
    text.remove_prefix(1);
  }
  while (!text.empty() && text.back() == ' ') {
    text.remove_suffix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

void store(const std::array<double, kMaxValues>& v, std::size_t count, std::int64_t stamp_ns,
           Sample& sample) {
  switch (sample.kind) {
    case Kind::kImu:
      sample.imu.stamp_ns = stamp_ns;
      sample.imu.gyro_rad_s = Eigen::Vector3d(v[0], v[1], v[2]);
      sample.imu.accel_m_s2 = Eigen::Vector3d(v[3], v[4], v[5]);
      sample.imu.has_attitude = count == kMaxValues;
      sample.imu.q_world_imu =
          count == kMaxValues ? Eigen::Quaterniond(v[6], v[7], v[8], v[9]) : Eigen::Quaterniond::Identity();
      break;
    case Kind::kPressure:
    case Kind::kBasePressure:
      sample.pressure = {stamp_ns, v[0], v[1]};
      break;
    case Kind::kWheel:
      sample.wheel = {stamp_ns, v[0], v[1], v[2]};
      break;
  }
}

const char* broken_rule(const Sample& sample) {
  if (const char* rule = implausible_stamp(sample.stamp_ns()); rule != nullptr) {
    return rule;
  }
  switch (sample.kind) {
    case Kind::kImu:
      return implausibility(sample.imu);
    case Kind::kWheel:
      return implausibility(sample.wheel);
    default:
      return implausibility(sample.pressure);
  }
}

/// Line builder. The caller's capacity, kMaxLineBytes, holds the longest line: no bounds checks.
class Line {
 public:
  explicit Line(std::span<char> out) : begin_(out.data()), at_(out.data()), end_(out.data() + out.size()) {}
  void word(std::string_view text) { at_ = std::copy(text.begin(), text.end(), at_); }
  template <typename Number>
  void number(Number value) {
    *at_++ = ',';
    at_ = std::to_chars(at_, end_, value).ptr;
  }
  std::size_t finish() {
    *at_++ = '\n';
    return static_cast<std::size_t>(at_ - begin_);
  }

 private:
  char* begin_;
  char* at_;
  char* end_;
};

}  // namespace

std::int64_t Sample::stamp_ns() const {
  switch (kind) {
    case Kind::kImu:
      return imu.stamp_ns;
    case Kind::kWheel:
      return wheel.stamp_ns;
    default:
      return pressure.stamp_ns;
  }
}

void Sample::set_stamp_ns(std::int64_t stamp_ns) {
  switch (kind) {
    case Kind::kImu:
      imu.stamp_ns = stamp_ns;
      break;
    case Kind::kWheel:
      wheel.stamp_ns = stamp_ns;
      break;
    default:
      pressure.stamp_ns = stamp_ns;
      break;
  }
}

LineStatus parse_line(std::string_view line, Sample& sample) {
  const std::string_view word = next_field(line);
  const auto found = std::find(kWords.begin(), kWords.end(), word);
  if (found == kWords.end()) {
    return LineStatus::kUnknownKind;
  }
  const auto kind = static_cast<std::size_t>(found - kWords.begin());
  sample.kind = static_cast<Kind>(kind);
  std::int64_t stamp_ns = 0;
  if (!parse(next_field(line), sample.sequence) || !parse(next_field(line), stamp_ns)) {
    return LineStatus::kMalformed;
  }
  std::array<double, kMaxValues> values{};
  std::size_t count = 0;
  while (!line.empty()) {
    const bool ends_with_comma = line.back() == ',';
    if (count == kMaxValues || ends_with_comma || !parse(next_field(line), values[count])) {
      return LineStatus::kMalformed;
    }
    ++count;
  }
  const bool with_attitude = sample.kind == Kind::kImu && count == kMaxValues;
  if (count != kValues[kind] && !with_attitude) {
    return LineStatus::kMalformed;
  }
  store(values, count, stamp_ns, sample);
  if (broken_rule(sample) != nullptr) {
    return LineStatus::kImplausible;
  }
  // A quaternion of unit length keeps its bits: formatting and parsing are lossless.
  if (with_attitude && std::abs(sample.imu.q_world_imu.squaredNorm() - 1.0) > 1e-12) {
    sample.imu.q_world_imu.normalize();
  }
  return LineStatus::kOk;
}

std::size_t format_line(const Sample& sample, std::span<char> out) {
  Line line(out);
  line.word(kWords[static_cast<std::size_t>(sample.kind)]);
  line.number(sample.sequence);
  line.number(sample.stamp_ns());
  switch (sample.kind) {
    case Kind::kImu: {
      for (const double rate : sample.imu.gyro_rad_s) {
        line.number(rate);
      }
      for (const double force : sample.imu.accel_m_s2) {
        line.number(force);
      }
      if (sample.imu.has_attitude) {
        const Eigen::Quaterniond& q = sample.imu.q_world_imu;
        for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
          line.number(part);
        }
      }
      break;
    }
    case Kind::kPressure:
    case Kind::kBasePressure:
      line.number(sample.pressure.pressure_pa);
      line.number(sample.pressure.temperature_c);
      break;
    case Kind::kWheel:
      line.number(sample.wheel.vx_m_s);
      line.number(sample.wheel.vy_m_s);
      line.number(sample.wheel.wz_rad_s);
      break;
  }
  return line.finish();
}

void DatagramParser::begin(std::span<const std::uint8_t> payload) {
  ++counters_.datagrams;
  rest_ = {reinterpret_cast<const char*>(payload.data()), payload.size()};
}

bool DatagramParser::next_line(Sample& sample, LineStatus& status) {
  while (!rest_.empty()) {
    const auto end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    if (line.empty()) {
      continue;
    }
    status = parse_line(line, sample);
    if (status == LineStatus::kOk || status == LineStatus::kImplausible) {
      return true;
    }
    ++(status == LineStatus::kMalformed ? counters_.malformed : counters_.unknown_kind);
  }
  return false;
}

bool DatagramParser::follow_sequence(const Sample& sample) {
  const auto kind = static_cast<std::size_t>(sample.kind);
  Stream& stream = streams_[kind];
  // Serial number arithmetic (RFC 1982): the difference modulo 2^32, read as a signed number.
  const auto ahead = static_cast<std::int32_t>(sample.sequence - stream.newest);
  const std::uint32_t behind = stream.newest - sample.sequence;
  const bool in_window = ahead <= 0 && behind < kReorderWindow;
  const bool seen = in_window && (stream.seen >> behind & 1U) != 0;
  const bool restarted = ahead > 0 ? static_cast<std::uint32_t>(ahead) > kMaxLoss
                                   : !in_window || (seen && sample.sequence == 0 && behind > 0);
  if (!stream.started || restarted) {
    counters_.restarts[kind] += stream.started ? 1 : 0;
    stream = {true, sample.sequence, 1};
    return true;
  }
  if (ahead > 0) {
    counters_.lost[kind] += static_cast<std::uint64_t>(ahead) - 1;
    stream.seen = ahead >= 64 ? 1 : stream.seen << static_cast<unsigned>(ahead) | 1U;
    stream.newest = sample.sequence;
    return true;
  }
  if (seen) {
    ++counters_.duplicated[kind];
    return false;
  }
  stream.seen |= std::uint64_t{1} << behind;
  ++counters_.reordered[kind];
  counters_.lost[kind] -= counters_.lost[kind] > 0 ? 1 : 0;  // was counted as lost
  return true;
}

}  // namespace isobar::datagram
