// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/added_logs.hpp"

#include <cmath>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "core/stamp.hpp"

namespace isobar::tools {
namespace {

bool is_file(const std::string& name) {
  std::error_code error;
  return !name.empty() && std::filesystem::is_regular_file(name, error);
}

template <typename Sample>
void add_row(const std::string& name, const std::string& type, const std::vector<Sample>& samples,
             const std::string& becomes, ImportReport& report) {
  const double span_s =
      samples.empty() ? 0.0 : seconds_between(samples.front().stamp_ns, samples.back().stamp_ns);
  report.rows.push_back({name, type, samples.size(),
                         span_s > 0.0 ? static_cast<double>(samples.size() - 1) / span_s : 0.0, becomes});
}

}  // namespace

AddedLogs::AddedLogs(const ImportRequest& request) : offset_s_(request.log_offset_s) {
  const auto read = [&](const std::string& name, LogContent content, std::optional<Named>& to) {
    if (is_file(name)) to = Named{name, read_sample_log(name, content, request.rate_hz)};
  };
  read(request.imu, LogContent::kImu, imu_);
  read(request.pressure, LogContent::kPressure, pressure_);
  read(request.base_pressure, LogContent::kPressure, base_pressure_);
  if (imu_ && imu_->log.imu.empty()) throw DataError(imu_->name + ": holds no sample of an IMU");
  for (const auto* named : {&pressure_, &base_pressure_}) {
    if (*named && (*named)->log.pressure.empty())
      throw DataError((*named)->name + ": holds no sample of a barometer");
  }
  // A log of both: its barometer counts, too, unless another is named.
  if (imu_ && !imu_->log.pressure.empty() && request.pressure.empty()) pressure_ = imu_;
  if (is_file(request.reference)) {
    reference_ = recording::read_tum(request.reference);
    reference_name_ = request.reference;
  }
}

ImportRequest AddedLogs::without(ImportRequest request) const {
  if (imu_) request.imu = kNoTopic;
  if (pressure_) request.pressure = kNoTopic;
  if (base_pressure_) request.base_pressure = kNoTopic;
  if (!reference_name_.empty()) request.reference = kNoTopic;
  return request;
}

void AddedLogs::use_source(const ImportRequest& request) {
  Named source{request.source.string(), read_sample_log(request.source, LogContent::kAny, request.rate_hz)};
  if (!imu_ && !source.log.imu.empty() && request.imu != kNoTopic) imu_ = source;
  if (!pressure_ && !source.log.pressure.empty() && request.pressure != kNoTopic) pressure_ = source;
}

void AddedLogs::use_imu(std::vector<ImuSample> samples, const std::string& name, const std::string& type) {
  SampleLog log;
  log.type = type;
  log.has_date = true;
  log.imu = std::move(samples);
  imu_ = Named{name, std::move(log)};
}

void AddedLogs::align(std::int64_t lidar_first_ns) {
  for (auto* named : {&imu_, &pressure_, &base_pressure_}) {
    if (!*named || (*named)->log.has_date) continue;
    SampleLog& log = (*named)->log;
    if (!offset_s_) {
      throw UsageError(
          "--log-offset: " + printable((*named)->name) + " (" + log.type +
          ") counts time from its own start; say --log-offset SECONDS, the time from the lidar's first "
          "packet to the log's first sample (negative: the log began before)");
    }
    const bool has_imu = !log.imu.empty();
    const std::int64_t first_ns = has_imu ? log.imu.front().stamp_ns : log.pressure.front().stamp_ns;
    log.shift(lidar_first_ns + std::llround(*offset_s_ * 1e9) - first_ns);
  }
}

void AddedLogs::add_to(recording::Manifest& manifest, const ImportRequest& request) const {
  const auto mounts = request.mounts();
  const auto mount_of_sensor = [&](const char* name) {
    const auto mount = mounts.find(name);
    return mount == mounts.end() ? Mount{} : mount->second;
  };
  if (imu_) {
    const bool is_vn100 = imu_->log.type == "VN-100";
    if (manifest.lidar && !mounts.contains("imu")) {
      throw UsageError(
          "--mount: how the IMU of " + printable(imu_->name) +
          " sits relative to the lidar is not known; say --mount imu=x,y,z,roll,pitch,yaw in base_link "
          "(m, degrees; imu=0,0,0," +
          (is_vn100 ? "180" : "0") + ",0,0 where its axes are the lidar's)");
    }
    manifest.imu = recording::SensorEntry{"imu.csv", mount_of_sensor("imu")};
    // A VN-100 counts z down.
    if (is_vn100 && !mounts.contains("imu")) manifest.imu->mount.rpy_deg.x() = 180.0;
  }
  if (pressure_) manifest.barometer = recording::SensorEntry{"barometer.csv", mount_of_sensor("barometer")};
  if (base_pressure_) manifest.base_barometer = recording::SensorEntry{"base_barometer.csv", {}};
  if (!reference_name_.empty()) manifest.reference = recording::SensorEntry{"reference.tum", {}};
}

void AddedLogs::write(recording::RecordingWriter& writer, ImportReport& report) const {
  const auto note = [&report](const Named& named) {
    for (const std::string& text : named.log.notes)
      report.notes.push_back(printable(named.name) + ": " + text);
  };
  if (imu_) {
    for (const ImuSample& sample : imu_->log.imu) writer.add_imu(sample);
    add_row(imu_->name, imu_->log.type, imu_->log.imu, "imu.csv", report);
    note(*imu_);
  }
  if (pressure_) {
    for (const PressureSample& sample : pressure_->log.pressure) writer.add_pressure(sample);
    add_row(pressure_->name, pressure_->log.type, pressure_->log.pressure, "barometer.csv: Pa", report);
    if (!imu_ || imu_->name != pressure_->name) note(*pressure_);
  }
  if (base_pressure_) {
    for (const PressureSample& sample : base_pressure_->log.pressure) writer.add_base_pressure(sample);
    add_row(base_pressure_->name, base_pressure_->log.type, base_pressure_->log.pressure,
            "base_barometer.csv: Pa", report);
    note(*base_pressure_);
  }
  for (const recording::StampedPose& pose : reference_) writer.add_reference(pose.stamp_ns, pose.T_map_base);
  if (!reference_.empty()) add_row(reference_name_, "TUM", reference_, "reference.tum", report);
}

}  // namespace isobar::tools
