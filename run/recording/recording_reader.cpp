// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/recording_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include "core/plausibility.hpp"
#include "run/recording/base_clock.hpp"
#include "run/recording/pcap_packets.hpp"
#include "run/recording/sample_csv.hpp"
#include "run/recording/stamp_order.hpp"

namespace isobar::recording {
namespace {

void store(const ImuSample& sample, Event& event) { event.imu = sample; }
void store(const PressureSample& sample, Event& event) { event.pressure = sample; }
void store(const WheelSample& sample, Event& event) { event.wheel = sample; }

void add_count(std::vector<Count>& counts, const std::string& name, std::uint64_t count,
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
  virtual void give(Event& event) = 0;  ///< the current event
  virtual void count(std::vector<Count>& counts) const = 0;
  [[nodiscard]] virtual std::uint64_t bytes_read() const = 0;
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
  void give(Event& event) override {
    event.kind = kind_;
    event.stamp_ns = current_.stamp_ns;
    event.packet = {};
    store(current_, event);
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
  void give(Event& event) override {
    std::swap(given_, next_);  // the event's bytes stay valid during the advance() that follows
    event.kind = EventKind::kLidarPacket;
    event.stamp_ns = given_.stamp_ns;
    event.packet = given_.payload;
    event.sender_ipv4 = given_.sender_ipv4;
  }
  void count(std::vector<Count>& counts) const override {
    const PcapPackets::Tallies& tallies = packets_.tallies();
    const auto add = [&counts](const char* what, const Tally& tally) {
      add_count(counts, std::string("lidar: ") + what, tally.count, tally.first_message);
    };
    add_count(counts, "lidar: packets", count_);
    add("frames for another port", tallies.other_port);
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

 private:
  PcapPackets packets_;
  StampedPacket next_;
  StampedPacket given_;
  std::uint64_t count_ = 0;
};

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

struct RecordingReader::Impl {
  std::filesystem::path folder;
  Manifest manifest;
  std::vector<std::string> warnings;
  BaseClock base_clock;
  std::vector<std::unique_ptr<Stream>> streams;
  std::vector<bool> alive;
  std::size_t given = 0;  // stream of the last event
  bool started = false;
  std::uint64_t bytes_total = 0;

  template <typename Made, typename... Arguments>
  void open(const std::string& file, Arguments&&... arguments) {
    bytes_total += size_of(folder / file);
    streams.push_back(std::make_unique<Made>(std::forward<Arguments>(arguments)...));
  }

  void open_all(const ReaderOptions& options);
  void tie_base();
  bool next(Event& event);
};

void RecordingReader::Impl::tie_base() {
  if (!manifest.base_barometer) {
    base_clock.reason = "no base station";
    return;
  }
  if (manifest.base_barometer->robot_clock) {
    base_clock.reason = "base-station stamps are on the robot's clock, as isobard converted them";
    return;
  }
  std::optional<StampSpan> robot;
  if (manifest.barometer) {
    robot = pressure_span(folder / manifest.barometer->file);
  }
  if (!robot && manifest.imu) {
    robot = imu_span(folder / manifest.imu->file);
  }
  base_clock = tie_base_clock(robot, pressure_span(folder / manifest.base_barometer->file));
}

void RecordingReader::Impl::open_all(const ReaderOptions& options) {
  StampGuardConfig guard;
  guard.max_forward_ns = options.max_gap_ns;
  tie_base();
  // Order of events with equal stamps: inputs of the prior before the lidar packets registered with it.
  if (manifest.imu) {
    open<SampleStream<ImuSample>>(manifest.imu->file, "imu", EventKind::kImu,
                                  open_imu_csv(folder / manifest.imu->file), 0, guard);
  }
  if (manifest.barometer) {
    open<SampleStream<PressureSample>>(manifest.barometer->file, "barometer", EventKind::kPressure,
                                       open_pressure_csv(folder / manifest.barometer->file), 0, guard);
  }
  if (manifest.base_barometer) {
    open<SampleStream<PressureSample>>(
        manifest.base_barometer->file, "base_barometer", EventKind::kBasePressure,
        open_pressure_csv(folder / manifest.base_barometer->file), base_clock.offset_ns, guard);
  }
  if (manifest.wheel) {
    open<SampleStream<WheelSample>>(manifest.wheel->file, "wheel", EventKind::kWheel,
                                    open_wheel_csv(folder / manifest.wheel->file), 0, guard);
  }
  if (manifest.lidar) {
    open<LidarStream>(manifest.lidar->file, folder / manifest.lidar->file,
                      LidarPorts{manifest.lidar->port, manifest.lidar->info_port}, guard);
  }
}

bool RecordingReader::Impl::next(Event& event) {
  if (!started) {
    started = true;
    for (const auto& stream : streams) {
      alive.push_back(stream->advance());
    }
  } else if (given < streams.size() && alive[given]) {
    alive[given] = streams[given]->advance();
  }
  given = streams.size();
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (alive[i] && (given == streams.size() || streams[i]->stamp_ns() < streams[given]->stamp_ns())) {
      given = i;
    }
  }
  if (given == streams.size()) {
    return false;
  }
  streams[given]->give(event);
  return true;
}

RecordingReader::RecordingReader(const std::filesystem::path& folder, const ReaderOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->folder = folder;
  impl_->manifest = read_manifest(folder, impl_->warnings);
  if (impl_->manifest.lidar && !impl_->manifest.lidar->calibration_file.empty()) {
    std::string& file = impl_->manifest.lidar->calibration_file;
    file = (folder / file).string();
  }
  impl_->open_all(options);
}

RecordingReader::~RecordingReader() = default;

bool RecordingReader::next(Event& event) { return impl_->next(event); }
const Manifest& RecordingReader::manifest() const { return impl_->manifest; }
const std::vector<std::string>& RecordingReader::warnings() const { return impl_->warnings; }
const BaseClock& RecordingReader::base_clock() const { return impl_->base_clock; }

std::vector<Count> RecordingReader::counts() const {
  std::vector<Count> counts;
  for (const auto& stream : impl_->streams) {
    stream->count(counts);
  }
  return counts;
}

double RecordingReader::progress() const {
  std::uint64_t read = 0;
  for (const auto& stream : impl_->streams) {
    read += stream->bytes_read();
  }
  return impl_->bytes_total == 0
             ? 1.0
             : std::min(1.0, static_cast<double>(read) / static_cast<double>(impl_->bytes_total));
}

}  // namespace isobar::recording
