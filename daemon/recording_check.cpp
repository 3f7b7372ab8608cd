// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/recording_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/contradictions/finding_text.hpp"
#include "core/contradictions/input_check.hpp"
#include "core/errors.hpp"
#include "daemon/cloud_scans.hpp"
#include "daemon/lidar_clock.hpp"
#include "daemon/lidar_sender.hpp"
#include "daemon/silent_lidar.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/text/number_text.hpp"

namespace isobar {

namespace {

using recording::EventKind;

/// Decoder and detectors behind the reader.
class CheckedInputs {
 public:
  explicit CheckedInputs(const Config& used)
      : sender_(used.lidar.sender),
        assembler_(make_lidar_decoder(stage_settings(used).lidar), used.lidar.time),
        clouds_(stage_settings(used).lidar.limits),
        check_({.imu = imu_mount(used), .lidar = used.lidar.mount}),
        scan_(std::make_unique<Scan>()),
        has_imu_(used.imu.present()),
        imu_of_lidar_(used.imu.source == ImuSource::kLidar),
        has_wheels_(used.wheel.present()) {}

  void handle(const recording::Event& event) {
    switch (event.kind) {
      case EventKind::kLidarPacket:
        if (sender_.admits(assembler_.decoder(), event.packet, event.sender_ipv4, event.stamp_ns) &&
            assembler_.add_packet(event.packet, event.stamp_ns, *scan_).scan_complete) {
          check_.add_scan(*scan_);
        }
        take_imu_of_lidar();
        break;
      case EventKind::kCloud:
        if (clouds_.decode(*event.cloud, *scan_)) check_.add_scan(*scan_);
        break;
      case EventKind::kImu:
        if (has_imu_ && !imu_of_lidar_) check_.add_imu(event.imu);
        break;
      case EventKind::kPressure:
        check_.add_pressure(event.pressure);
        break;
      case EventKind::kBasePressure:
        check_.add_base_pressure(event.pressure);
        break;
      case EventKind::kWheel:
        if (has_wheels_) check_.add_wheel(event.wheel);
        break;
    }
  }
  void finish() {
    if (assembler_.flush(*scan_)) check_.add_scan(*scan_);
  }
  [[nodiscard]] const InputCheck& check() const { return check_; }
  [[nodiscard]] const ScanAssembler& assembler() const { return assembler_; }
  [[nodiscard]] std::uint64_t scans() const { return assembler_.counters().scans + clouds_.scans(); }

 private:
  void take_imu_of_lidar() {
    ImuSample sample;
    while (imu_of_lidar_ && assembler_.take_imu(sample)) check_.add_imu(sample);
  }

  LidarSender sender_;
  ScanAssembler assembler_;
  CloudScans clouds_;
  InputCheck check_;
  std::unique_ptr<Scan> scan_;
  bool has_imu_;
  bool imu_of_lidar_;
  bool has_wheels_;
};

/// Rows that the reader refused as implausible, of a sensor whose unit no good row could tell: rates in deg/s or speeds in
/// mm/s are beyond every range while the robot moves. One in a hundred, and twenty at least: no transport errs so often.
void add_refused_rows(const std::vector<recording::Count>& counts, const char* stream, CheckedSensor sensor,
                      Contradiction kind, const char* rule, Findings& findings) {
  constexpr std::uint64_t kLeastRows = 20;
  constexpr std::uint64_t kShare = 100;
  const auto count_of = [&](const std::string& name) {
    const auto found = std::find_if(counts.begin(), counts.end(),
                                    [&](const recording::Count& count) { return count.name == name; });
    return found == counts.end() ? recording::Count{} : *found;
  };
  const recording::Count refused = count_of(std::string(stream) + ": implausible rows");
  const std::uint64_t good = count_of(std::string(stream) + ": good rows").count;
  if (refused.count < kLeastRows || refused.count * kShare < good) return;
  if (refused.first_message.find(rule) == std::string::npos || findings.find(kind) != nullptr) return;
  findings.add(
      {.kind = kind, .sensor = sensor, .confidence = 1.0, .evidence = static_cast<double>(refused.count)});
}

/// Files that begin and end apart by the same: what a clock that is off looks like, and what a recorder that was started and
/// stopped apart may look like. For a robot whose turns tell nothing.
void add_shifted_files(const RecordingCheck& check, std::vector<std::string>& notes) {
  constexpr double kLeastShiftS = 1.0;
  constexpr double kSameShiftS = 0.3;
  const StreamTimes& lidar = check.times[static_cast<std::size_t>(CheckedSensor::kLidar)];
  for (const CheckedSensor sensor :
       {CheckedSensor::kImu, CheckedSensor::kBarometer, CheckedSensor::kWheels}) {
    const StreamTimes& times = check.times[static_cast<std::size_t>(sensor)];
    if (times.count() < 2 || lidar.count() < 2 || overlap_s(times, lidar) < 0.0) continue;
    const double begin_s = seconds_between(lidar.first_ns(), times.first_ns());
    const double end_s = seconds_between(lidar.last_ns(), times.last_ns());
    if (std::abs(begin_s) < kLeastShiftS || std::abs(begin_s - end_s) > kSameShiftS) continue;
    notes.push_back(std::string(kCheckedSensorNames.name(sensor)) + ": begins and ends " +
                    clock_difference_text(begin_s) + (begin_s < 0.0 ? " before" : " after") +
                    " the lidar: is its clock off by that?");
  }
}

/// What a capture without a scan holds instead, and why a file ends early.
void add_what_was_found(const recording::RecordingReader& reader, const CheckedInputs& inputs,
                        RecordingCheck& out) {
  const ScanAssembler& assembler = inputs.assembler();
  if (reader.manifest().lidar && inputs.scans() == 0) {
    out.silent_lidar = "no lidar scan could be decoded: " + silent_lidar_text(reader, assembler);
    return;
  }
  if (const char* text = assembler.decoder().contradiction(); reader.manifest().lidar && text != nullptr) {
    out.warnings.emplace_back(std::string("lidar: ") + text);
  }
  for (const recording::Count& count : out.counts) {
    const bool note = count.name == "lidar: file truncated" || count.name == "clock of the recording set";
    if (note) out.notes.push_back(count.first_message);
  }
}

/// An IMU that is over about when its attitude begins: no scan before that has a pose, and the map would stay empty.
void leave_out_short_imu(const Config& used, RecordingCheck& out) {
  const double start_s = used.prior.attitude.start_time_s;
  const StreamTimes& imu = out.times[static_cast<std::size_t>(CheckedSensor::kImu)];
  if (!used.imu.present() || imu.count() == 0 || imu.length_s() >= 2.0 * start_s) return;
  out.usable.imu = false;
  out.notes.push_back("imu: " + text::number_text(std::round(imu.length_s() * 100.0) / 100.0) +
                      " s of readings are too short: its attitude begins after " +
                      text::number_text(start_s) + " s; the run goes without it");
}

/// The finding that leaves no pose with gravity: wheels or a barometer without a common time are left out.
const Finding* missing_overlap(const Findings& findings) {
  for (const Finding& finding : findings.all()) {
    const bool is_needed = finding.sensor == CheckedSensor::kImu || finding.sensor == CheckedSensor::kLidar;
    if (finding.kind == Contradiction::kNoOverlap && is_needed) return &finding;
  }
  return nullptr;
}

}  // namespace

RecordingCheck check_recording(const std::filesystem::path& recording, const Config& used,
                               const std::function<void(double)>& progress) {
  recording::RecordingReader reader(recording);
  reader.use_lidar_clock(lidar_clock(stage_settings(used).lidar));
  CheckedInputs inputs(used);
  recording::Event event;
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    inputs.handle(event);
    if (events % 512 == 0) progress(reader.progress());
  }
  inputs.finish();
  RecordingCheck out;
  out.findings = inputs.check().find();
  inputs.check().add_overlaps(out.findings);
  inputs.check().add_clocks(out.findings);
  out.counts = reader.counts();
  if (used.imu.present()) {
    add_refused_rows(out.counts, "imu", CheckedSensor::kImu, Contradiction::kGyroUnit,
                     "angular rate must lie", out.findings);
  }
  add_refused_rows(out.counts, "wheel", CheckedSensor::kWheels, Contradiction::kWheelUnit, "wheel ",
                   out.findings);
  out.usable = usable_sensors(out.findings);
  for (std::size_t i = 0; i < kCheckedSensors; ++i) {
    out.times[i] = inputs.check().times(static_cast<CheckedSensor>(i));
  }
  leave_out_short_imu(used, out);
  if (out.findings.empty()) add_shifted_files(out, out.notes);
  add_what_was_found(reader, inputs, out);
  out.warnings = reader.warnings();
  if (reader.manifest().base_barometer) out.base_clock = reader.base_clock().reason;
  return out;
}

recording::Manifest without_unusable(recording::Manifest manifest, const UsableSensors& usable) {
  // The lidar's own IMU comes with its other packets.
  if (!usable.imu && !manifest.imu && manifest.lidar) manifest.lidar->info_port = 0;
  if (!usable.imu) manifest.imu.reset();
  if (!usable.wheels) manifest.wheel.reset();
  if (!usable.barometers) manifest.barometer.reset();
  if (!usable.barometers) manifest.base_barometer.reset();
  return manifest;
}

bool is_used(EventKind kind, const UsableSensors& usable) {
  switch (kind) {
    case EventKind::kLidarPacket:
    case EventKind::kCloud:
      return true;
    case EventKind::kImu:
      return usable.imu;
    case EventKind::kPressure:
    case EventKind::kBasePressure:
      return usable.barometers;
    case EventKind::kWheel:
      return usable.wheels;
  }
  return true;
}

void refuse_clocks_apart(const RecordingCheck& check, const std::filesystem::path& recording) {
  if (const Finding* apart = missing_overlap(check.findings)) {
    throw DataError(recording.string() + ": " + finding_text(*apart));
  }
}

std::vector<std::string> contradiction_texts(const RecordingCheck& check) {
  std::vector<std::string> texts;
  for (const Finding& finding : check.findings.all()) texts.push_back(finding_text(finding));
  if (std::string left_out = left_out_text(check.usable); !left_out.empty())
    texts.push_back(std::move(left_out));
  texts.insert(texts.end(), check.notes.begin(), check.notes.end());
  return texts;
}

}  // namespace isobar
