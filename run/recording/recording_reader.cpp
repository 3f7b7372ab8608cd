// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/recording_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <system_error>
#include <utility>

#include "run/recording/base_clock.hpp"
#include "run/recording/recording_streams.hpp"
#include "run/recording/sample_csv.hpp"
#include "run/recording/time_base.hpp"

namespace isobar::recording {
namespace {

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

/// Steps of the clock that were taken out.
void add_steps(const TimeBase& time_base, std::vector<Count>& counts) {
  if (time_base.steps() == 0) return;
  const std::int64_t step_ns = time_base.first_step_ns();
  const double step_s = 1e-9 * static_cast<double>(step_ns);
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "the clock was set %s by %.3f s at %.3f s since 1970: time goes on without that step",
                step_ns < 0 ? "back" : "forward", std::abs(step_s),
                1e-9 * static_cast<double>(time_base.first_step_at_ns()));
  counts.push_back({"clock of the recording set", time_base.steps(), text.data()});
}

}  // namespace

struct RecordingReader::Impl {
  std::filesystem::path folder;
  Manifest manifest;
  std::vector<std::string> warnings;
  BaseClock base_clock;
  std::vector<std::unique_ptr<Stream>> streams;
  std::vector<TimeBase::Stream> clocks;  // of the streams
  LidarClock lidar_clock;
  std::optional<TimeBase> time_base;  // from the first event on
  std::size_t given = 0;              // stream of the last event
  std::uint64_t bytes_total = 0;

  template <typename Made, typename... Arguments>
  void open(const std::string& file, bool robot_clock, Arguments&&... arguments) {
    clocks.push_back({robot_clock, 0});
    bytes_total += size_of(folder / file);
    streams.push_back(std::make_unique<Made>(std::forward<Arguments>(arguments)...));
  }

  void open_all(const ReaderOptions& options);
  void tie_base();
  void advance(std::size_t stream);
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
  guard.max_reorder_ns = options.max_reorder_ns;
  tie_base();
  // Order of events with equal stamps: inputs of the prior before the lidar packets registered with it.
  if (manifest.imu) {
    open<SampleStream<ImuSample>>(manifest.imu->file, true, "imu", EventKind::kImu,
                                  open_imu_csv(folder / manifest.imu->file), 0, guard);
  }
  if (manifest.barometer) {
    open<SampleStream<PressureSample>>(manifest.barometer->file, true, "barometer", EventKind::kPressure,
                                       open_pressure_csv(folder / manifest.barometer->file), 0, guard);
  }
  if (manifest.base_barometer) {
    open<SampleStream<PressureSample>>(manifest.base_barometer->file, manifest.base_barometer->robot_clock,
                                       "base_barometer", EventKind::kBasePressure,
                                       open_pressure_csv(folder / manifest.base_barometer->file),
                                       base_clock.offset_ns, guard);
  }
  if (manifest.wheel) {
    open<SampleStream<WheelSample>>(manifest.wheel->file, true, "wheel", EventKind::kWheel,
                                    open_wheel_csv(folder / manifest.wheel->file), 0, guard);
  }
  if (manifest.lidar && manifest.lidar->holds_clouds()) {
    open<CloudStream>(manifest.lidar->file, true, folder / manifest.lidar->file);
  } else if (manifest.lidar) {
    open<LidarStream>(manifest.lidar->file, true, folder / manifest.lidar->file,
                      LidarPorts{manifest.lidar->port, manifest.lidar->info_port}, guard);
  }
}

void RecordingReader::Impl::advance(std::size_t stream) {
  if (!streams[stream]->advance()) {
    time_base->end(stream);
    return;
  }
  time_base->take(stream, streams[stream]->stamp_ns(),
                  [&] { return streams[stream]->elapsed_ns(lidar_clock); });
}

bool RecordingReader::Impl::next(Event& event) {
  if (!time_base) {
    if (manifest.lidar) clocks.back().period_ns = lidar_clock.period_ns;
    time_base.emplace(clocks);
    for (std::size_t i = 0; i < streams.size(); ++i) advance(i);
  } else if (given < streams.size()) {
    advance(given);
  }
  const std::optional<std::size_t> chosen = time_base->choose();
  given = chosen.value_or(streams.size());
  if (!chosen) return false;
  streams[given]->give(time_base->shift_ns(given), event);
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

void RecordingReader::use_lidar_clock(LidarClock clock) { impl_->lidar_clock = std::move(clock); }
bool RecordingReader::next(Event& event) { return impl_->next(event); }
const Manifest& RecordingReader::manifest() const { return impl_->manifest; }
const std::vector<std::string>& RecordingReader::warnings() const { return impl_->warnings; }
const BaseClock& RecordingReader::base_clock() const { return impl_->base_clock; }

std::vector<Count> RecordingReader::counts() const {
  std::vector<Count> counts;
  for (const auto& stream : impl_->streams) {
    stream->count(counts);
  }
  if (impl_->time_base) add_steps(*impl_->time_base, counts);
  return counts;
}

const PortsSeen& RecordingReader::other_ports() const {
  static const PortsSeen none;
  for (const auto& stream : impl_->streams) {
    if (stream->other_ports() != nullptr) return *stream->other_ports();
  }
  return none;
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
