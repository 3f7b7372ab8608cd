// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/recording_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/csv_writer.hpp"
#include "run/recording/pcap_file.hpp"
#include "run/recording/reference.hpp"
#include "run/recording/udp_frame.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

TextFile& present(std::optional<TextFile>& file, const char* sensor) {
  if (!file) {
    throw std::logic_error(std::string("RecordingWriter: the manifest has no ") + sensor);
  }
  return *file;
}

constexpr const char* kImuHeader = "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
constexpr const char* kAttitudeHeader = ",qw,qx,qy,qz\n";
constexpr const char* kWheelHeader = "t_ns,vx_m_s,vy_m_s,wz_rad_s";
constexpr const char* kVarianceHeader = ",vx_variance_m2_s2,vy_variance_m2_s2,wz_variance_rad2_s2\n";

void write_pressure(TextFile& file, const PressureSample& sample, bool every_column) {
  CsvRow row;
  row.add(sample.stamp_ns).add(sample.pressure_pa).add(sample.temperature_c);
  if (every_column) {
    row.add(sample.variance_pa2).add(static_cast<std::int64_t>(sample.station));
  }
  file.write(row.finish());
}

}  // namespace

struct RecordingWriter::Files {
  std::filesystem::path folder;
  Manifest manifest;
  bool every_column = false;
  std::optional<PcapFile> lidar;
  std::optional<CloudFileWriter> clouds;
  std::optional<TextFile> imu;
  std::optional<TextFile> barometer;
  std::optional<TextFile> base_barometer;
  std::optional<TextFile> wheel;
  std::optional<TextFile> reference;
  std::optional<TextFile> segments;
  std::optional<bool> imu_has_attitude;    // set by the first sample
  std::optional<bool> wheel_has_variance;  // likewise
  std::vector<std::uint8_t> frame;
  std::vector<std::uint8_t> fragment;
  std::uint16_t identification = 0;

  std::array<std::optional<TextFile>*, 6> text_files() {
    return {&imu, &barometer, &base_barometer, &wheel, &reference, &segments};
  }
  void open_csv(std::optional<TextFile>& file, const std::optional<SensorEntry>& entry, const char* header) {
    if (entry) {
      file.emplace(folder / entry->file);
      file->write(header);
    }
  }
};

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, const Manifest& manifest,
                                 const WriterOptions& options)
    : files_(std::make_unique<Files>()) {
  if (std::filesystem::exists(folder / kManifestFile)) {
    throw DataError(folder.string() + ": already holds a recording");
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw DataError(folder.string() + ": cannot be made: " + error.message());
  }
  files_->folder = folder;
  files_->manifest = manifest;
  files_->every_column = options.every_column;
  write_manifest(folder, manifest);
  if (manifest.lidar && manifest.lidar->holds_clouds()) {
    files_->clouds.emplace(folder / manifest.lidar->file);
  } else if (manifest.lidar) {
    files_->lidar.emplace(folder / manifest.lidar->file);
  }
  const char* pressure_header = options.every_column ? "t_ns,pressure_pa,temperature_c,variance_pa2,station\n"
                                                     : "t_ns,pressure_pa,temperature_c\n";
  files_->open_csv(files_->imu, manifest.imu, "");
  files_->open_csv(files_->barometer, manifest.barometer, pressure_header);
  files_->open_csv(files_->base_barometer, manifest.base_barometer, pressure_header);
  files_->open_csv(files_->wheel, manifest.wheel, "");
  if (files_->imu && options.every_column) {
    files_->imu_has_attitude = true;
    files_->imu->write(kImuHeader);
    files_->imu->write(kAttitudeHeader);
  }
  files_->open_csv(files_->reference, manifest.reference, "# t x y z qx qy qz qw\n");
}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload) {
  if (!files_->manifest.lidar) {
    throw std::logic_error("RecordingWriter: the manifest has no lidar");
  }
  add_packet(stamp_ns, payload, files_->manifest.lidar->port);
}

void RecordingWriter::add_packet(std::int64_t stamp_ns, std::span<const std::uint8_t> payload,
                                 std::uint16_t port, std::uint32_t sender_ipv4) {
  if (!files_->lidar) {
    throw std::logic_error("RecordingWriter: the manifest has no lidar");
  }
  if (payload.size() > kMaxUdpPayloadBytes) {
    throw std::logic_error("RecordingWriter: no UDP packet is that long");
  }
  build_udp_frame(payload, port, files_->identification++, files_->frame, sender_ipv4);
  const std::size_t fragments = fragment_count(files_->frame.size());
  if (fragments == 1) files_->lidar->write(stamp_ns, files_->frame);
  for (std::size_t i = 0; fragments > 1 && i < fragments; ++i) {
    build_fragment(files_->frame, i, files_->fragment);
    files_->lidar->write(stamp_ns, files_->fragment);
  }
}

bool RecordingWriter::add_cloud(const CloudRecord& cloud) {
  if (!files_->clouds) throw std::logic_error("RecordingWriter: the manifest has no lidar of clouds");
  return files_->clouds->write(cloud);
}

void RecordingWriter::add_imu(const ImuSample& sample) {
  TextFile& file = present(files_->imu, "imu");
  if (!files_->imu_has_attitude) {
    files_->imu_has_attitude = sample.has_attitude;
    file.write(kImuHeader);
    file.write(sample.has_attitude ? kAttitudeHeader : "\n");
  }
  CsvRow row;
  row.add(sample.stamp_ns);
  for (const double rate : sample.gyro_rad_s) {
    row.add(rate);
  }
  for (const double force : sample.accel_m_s2) {
    row.add(force);
  }
  if (*files_->imu_has_attitude) {
    const Eigen::Quaterniond& q = sample.q_world_imu;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
      row.add(sample.has_attitude ? part : unknown);
    }
  }
  file.write(row.finish());
}

void RecordingWriter::add_pressure(const PressureSample& sample) {
  write_pressure(present(files_->barometer, "barometer"), sample, files_->every_column);
}

void RecordingWriter::add_base_pressure(const PressureSample& sample) {
  write_pressure(present(files_->base_barometer, "base_barometer"), sample, files_->every_column);
}

void RecordingWriter::add_wheel(const WheelSample& sample) {
  TextFile& file = present(files_->wheel, "wheel");
  const std::array<double, 3> variances{sample.vx_variance_m2_s2, sample.vy_variance_m2_s2,
                                        sample.wz_variance_rad2_s2};
  if (!files_->wheel_has_variance) {
    const auto is_stated = [](double variance) { return !std::isnan(variance); };
    files_->wheel_has_variance =
        files_->every_column || std::any_of(variances.begin(), variances.end(), is_stated);
    file.write(kWheelHeader);
    file.write(*files_->wheel_has_variance ? kVarianceHeader : "\n");
  }
  CsvRow row;
  row.add(sample.stamp_ns).add(sample.vx_m_s).add(sample.vy_m_s).add(sample.wz_rad_s);
  if (*files_->wheel_has_variance) {
    for (const double variance : variances) row.add(variance);
  }
  file.write(row.finish());
}

void RecordingWriter::add_reference(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) {
  present(files_->reference, "reference").write(format_tum_row(stamp_ns, T_map_base));
}

void RecordingWriter::add_segment(const text::Segment& segment) {
  if (!files_->segments) {
    files_->segments.emplace(files_->folder / kSegmentsFile);
    files_->segments->write("t_start_ns,t_end_ns,label\n");
  }
  files_->segments->write(text::number_text(segment.start_ns) + "," + text::number_text(segment.end_ns) +
                          "," + segment.label + "\n");
}

void RecordingWriter::flush() {
  if (files_->lidar) {
    files_->lidar->flush();
  }
  if (files_->clouds) files_->clouds->flush();
  for (std::optional<TextFile>* file : files_->text_files()) {
    if (*file) {
      (*file)->flush();
    }
  }
}

void RecordingWriter::close() {
  if (files_->imu && !files_->imu_has_attitude) {
    files_->imu_has_attitude = false;
    files_->imu->write(kImuHeader);
    files_->imu->write("\n");
  }
  if (files_->wheel && !files_->wheel_has_variance) {
    files_->wheel_has_variance = false;
    files_->wheel->write(kWheelHeader);
    files_->wheel->write("\n");
  }
  if (files_->lidar) {
    files_->lidar->close();
  }
  if (files_->clouds) files_->clouds->close();
  for (std::optional<TextFile>* file : files_->text_files()) {
    if (*file) {
      (*file)->close();
    }
  }
}

}  // namespace isobar::recording
