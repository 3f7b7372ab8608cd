// SPDX-License-Identifier: BSD-3-Clause
// The files of a recording as streams of events, for RecordingReader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/plausibility.hpp"
#include "run/recording/cloud_file.hpp"
#include "run/recording/pcap_packets.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/sample_csv.hpp"
#include "run/recording/stamp_order.hpp"

namespace isobar::recording {

inline ImuSample& place_of(const ImuSample* /*kind*/, Event& event) { return event.imu; }
inline PressureSample& place_of(const PressureSample* /*kind*/, Event& event) { return event.pressure; }
inline WheelSample& place_of(const WheelSample* /*kind*/, Event& event) { return event.wheel; }

inline void add_count(std::vector<Count>& counts, const std::string& name, std::uint64_t count,
                      const std::string& first_message = {}) {
  if (count > 0) {
    counts.push_back({name, count, first_message});
  }
}

/// One file of the recording, with its next event.
class Stream {
 public:
  Stream() = default;
  virtual ~Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  virtual bool advance() = 0;  ///< false at the end
  [[nodiscard]] virtual std::int64_t stamp_ns() const = 0;
  /// The current event.
  /// @param shift_ns added to its stamp
  virtual void give(std::int64_t shift_ns, Event& event) = 0;
  /// Time on the sensor's own clock from the event given last to the current one.
  [[nodiscard]] virtual std::optional<std::int64_t> elapsed_ns(const LidarClock& /*clock*/) const {
    return std::nullopt;
  }
  virtual void count(std::vector<Count>& counts) const = 0;
  [[nodiscard]] virtual std::uint64_t bytes_read() const = 0;
  [[nodiscard]] virtual const PortsSeen* other_ports() const { return nullptr; }
};

template <typename Sample>
class SampleStream : public Stream {
 public:
  SampleStream(std::string name, EventKind kind, text::CsvReader&& csv, std::int64_t offset_ns,
               const StampGuardConfig& guard)
      : name_(std::move(name)), kind_(kind), csv_(std::move(csv)), offset_ns_(offset_ns), order_(guard) {}

  bool advance() override {
    return order_.next(current_, [this](Sample& sample) {
      while (next_sample(csv_, sample, malformed_, implausible_)) {
        sample.stamp_ns += offset_ns_;
        if (const char* rule = implausible_stamp(sample.stamp_ns); rule != nullptr) {
          implausible_.add([&] { return csv_.lines().place() + rule + ", on the robot's clock"; });
          continue;
        }
        ++rows_;
        return true;
      }
      return false;
    });
  }
  [[nodiscard]] std::int64_t stamp_ns() const override { return current_.stamp_ns; }
  void give(std::int64_t shift_ns, Event& event) override {
    event.kind = kind_;
    event.stamp_ns = current_.stamp_ns + shift_ns;
    event.packet = {};
    Sample& sample = place_of(&current_, event);
    sample = current_;
    sample.stamp_ns = event.stamp_ns;
  }
  void count(std::vector<Count>& counts) const override {
    const StampGuard& guard = order_.guard();
    add_count(counts, name_ + ": good rows", rows_);
    add_count(counts, name_ + ": malformed rows", malformed_.count, malformed_.first_message);
    add_count(counts, name_ + ": implausible rows", implausible_.count, implausible_.first_message);
    add_count(counts, name_ + ": repeated stamps", order_.counts().duplicates);
    add_count(counts, name_ + ": reordered rows", guard.reordered());
    add_count(counts, name_ + ": rows too late to be sorted in", order_.counts().too_late);
    add_count(counts, name_ + ": absurd stamps", order_.counts().absurd);
    add_count(counts, name_ + ": gaps", guard.gaps());
    add_count(counts, name_ + ": clock set back", guard.steps_back());
    const std::string damage = csv_.lines().damage();
    add_count(counts, name_ + ": file damaged", damage.empty() ? 0 : 1, damage);
  }
  [[nodiscard]] std::uint64_t bytes_read() const override { return csv_.lines().bytes_read(); }

 private:
  std::string name_;
  EventKind kind_;
  text::CsvReader csv_;
  std::int64_t offset_ns_;
  StampOrder<Sample> order_;
  Sample current_;
  std::uint64_t rows_ = 0;
  Tally malformed_;
  Tally implausible_;
};

class CloudStream : public Stream {
 public:
  explicit CloudStream(const std::filesystem::path& file) : clouds_(file) {}

  bool advance() override {
    while (clouds_.next(next_)) {
      // The sum of two foreign numbers must not overflow.
      const bool plausible = implausible_stamp(next_.stamp_ns) == nullptr &&
                             next_.shift_ns > -kPlausibleStampHighestNs &&
                             next_.shift_ns < kPlausibleStampHighestNs &&
                             implausible_stamp(next_.stamp_ns + next_.shift_ns) == nullptr;
      count_ += plausible ? 1 : 0;
      absurd_ += plausible ? 0 : 1;
      if (plausible) return true;
    }
    return false;
  }
  [[nodiscard]] std::int64_t stamp_ns() const override { return next_.stamp_ns + next_.shift_ns; }
  void give(std::int64_t shift_ns, Event& event) override {
    std::swap(given_, next_);  // the event's cloud stays valid during the advance() that follows
    given_.shift_ns += shift_ns;
    event.kind = EventKind::kCloud;
    event.stamp_ns = given_.stamp_ns + given_.shift_ns;
    event.packet = {};
    event.cloud = &given_;
  }
  void count(std::vector<Count>& counts) const override {
    const CloudFileReader::Tallies& tallies = clouds_.tallies();
    add_count(counts, "lidar: clouds", count_);
    add_count(counts, "lidar: absurd stamps", absurd_);
    add_count(counts, "lidar: damaged clouds", tallies.damaged.count, tallies.damaged.first_message);
    add_count(counts, "lidar: file truncated", tallies.truncated.count, tallies.truncated.first_message);
  }
  [[nodiscard]] std::uint64_t bytes_read() const override { return clouds_.bytes_read(); }

 private:
  CloudFileReader clouds_;
  CloudRecord next_;
  CloudRecord given_;
  std::uint64_t count_ = 0;
  std::uint64_t absurd_ = 0;
};

class LidarStream : public Stream {
 public:
  LidarStream(const std::filesystem::path& file, const LidarPorts& ports, const StampGuardConfig& guard)
      : packets_(file, ports, guard) {}

  bool advance() override {
    const bool more = packets_.next(next_);
    count_ += more ? 1 : 0;
    return more;
  }
  [[nodiscard]] std::int64_t stamp_ns() const override { return next_.stamp_ns; }
  void give(std::int64_t shift_ns, Event& event) override {
    std::swap(given_, next_);  // the event's bytes stay valid during the advance() that follows
    event.kind = EventKind::kLidarPacket;
    event.stamp_ns = given_.stamp_ns + shift_ns;
    event.packet = given_.payload;
    event.sender_ipv4 = given_.sender_ipv4;
    event.port = given_.port;
  }
  [[nodiscard]] std::optional<std::int64_t> elapsed_ns(const LidarClock& clock) const override {
    return clock.elapsed_ns ? clock.elapsed_ns(given_.payload, next_.payload) : std::nullopt;
  }
  void count(std::vector<Count>& counts) const override {
    const PcapPackets::Tallies& tallies = packets_.tallies();
    const auto add = [&counts](const char* what, const Tally& tally) {
      add_count(counts, std::string("lidar: ") + what, tally.count, tally.first_message);
    };
    add_count(counts, "lidar: packets", count_);
    add_count(counts, "lidar: frames for another port", tallies.other_port.count,
              packets_.ports_text("the recording"));
    add("frames of another link type", tallies.other_link);
    add("frames of another protocol", tallies.other_protocol);
    add("malformed frames", tallies.malformed);
    add("packets cut by the capture", tallies.cut);
    add("absurd stamps", tallies.absurd_stamp);
    add("file truncated", tallies.file_truncated);
    add_count(counts, "lidar: packets put together from IP fragments", packets_.extractor().reassembled());
    add_count(counts, "lidar: packets with IP fragments missing", packets_.extractor().incomplete());
    add_count(counts, "lidar: gaps", packets_.guard().gaps());
    add_count(counts, "lidar: clock set back", packets_.guard().steps_back());
  }
  [[nodiscard]] std::uint64_t bytes_read() const override { return packets_.bytes_read(); }
  [[nodiscard]] const PortsSeen* other_ports() const override { return &packets_.extractor().other_ports(); }

 private:
  PcapPackets packets_;
  StampedPacket next_;
  StampedPacket given_;
  std::uint64_t count_ = 0;
};

}  // namespace isobar::recording
